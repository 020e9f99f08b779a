// Runs one of this project's programs as a user's script would.
#pragma once
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#ifndef _WIN32
#include <sys/wait.h>
#endif

#include "tests/TempFolder.h"

namespace rt::tests {

struct ProgramResult {
    int exitCode = -1;  // 128 + signal when it crashed
    std::string out;    // standard output
    std::string err;    // standard error
};

inline std::string quoted(const std::string& argument) {
    return '"' + argument + '"';
}

inline std::string readText(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Arguments must not contain quotes. `before` is put in front of the command, `after` behind it, for the shell;
// whatever `after` redirects is not in the result.
inline ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments,
                                const std::string& before = "", const std::string& after = "") {
    const TempFolder folder;
    std::string command = before + quoted((std::filesystem::path(RT_PROGRAM_DIR) / program).string());
    for (const std::string& argument : arguments)
        command += ' ' + quoted(argument);
    command += " >" + quoted((folder / "out").string()) + " 2>" + quoted((folder / "err").string()) + ' ' + after;
#ifdef _WIN32
    const int code = std::system(quoted(command).c_str());
#else
    const int status = std::system(command.c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
#endif
    return {code, readText(folder / "out"), readText(folder / "err")};
}

}  // namespace rt::tests
