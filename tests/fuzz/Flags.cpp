// Command lines: each line of an input is an argument of ray-tracing-gpu where the first is "gpu", else of
// ray-tracing-cpu. Configuration files are the target of Config.cpp: --config, which would read any file, is left out.
#include <sstream>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    static app::OptionParser cpu(app::kCpuProgram), gpu(app::kGpuProgram);
    app::OptionParser* parser = &cpu;
    std::vector<std::string> arguments = {"--no-config", "--headless"};
    std::istringstream lines{std::string(test::textOf(data, size))};
    for (std::string line; std::getline(lines, line);) {
        if (line == "gpu" && arguments.size() == 2)
            parser = &gpu;
        else if (!line.starts_with("--config"))
            arguments.push_back(line);
    }
    test::readOrRefuse([&] {
        std::ostringstream out;
        if (auto options = parser->parse(std::move(arguments), out)) app::settleImageSize(*options, "f", 1.5);
    });
    return 0;
}
