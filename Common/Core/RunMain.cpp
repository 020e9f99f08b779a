#include "Common/Core/RunMain.h"

#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Core/NewFile.h"
#include "Common/Core/Printable.h"

namespace rt {

namespace {

int report(const char* program, std::string_view message, ExitCode code) {
    std::cerr << program << ": " << printable(message) << std::endl;
    return static_cast<int>(code);
}

} // namespace

int runMain(const char* program, const std::function<int()>& body) {
    openStandardStreams();
#ifdef SIGPIPE
    std::signal(SIGPIPE, SIG_IGN); // so is a reader that has gone: of progress, that is no reason to lose a render
#endif
#ifdef SIGXFSZ
    std::signal(SIGXFSZ, SIG_IGN); // a limit of the size of files is a failing write like any other
#endif
    try {
        const int code = body();
        std::cout.flush();
        if (!std::cout) throw RenderError("cannot write to standard output");
        return code;
    } catch (const Error& error) {
        return report(program, error.what(), error.code());
    } catch (const std::filesystem::filesystem_error& error) {
        return report(program, error.path1().string() + ": " + error.code().message(), ExitCode::Failure);
    } catch (const std::bad_alloc&) {
        return report(program, "not enough memory", ExitCode::Failure);
    } catch (const std::exception& error) {
        return report(program, error.what(), ExitCode::Failure);
    }
}

} // namespace rt
