// history.jsonl, read, searched and written as the windows do.
#include "Common/App/Interactive/RunHistory.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    app::RunHistory history(test::fuzzFolder().write("history.jsonl", test::textOf(data, size)));
    std::vector<const app::RunRecord*> newestFirst;
    for (const app::RunRecord& record : history.records()) {
        app::toJsonLine(record);
        newestFirst.insert(newestFirst.begin(), &record);
    }
    app::newestOfEqualWork(newestFirst);
    app::toCsv(history.records());
    return 0;
}
