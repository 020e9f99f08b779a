// Errors while loading and setting up are exceptions that end in one clear line and a documented exit code.
#pragma once
#include <exception>
#include <stdexcept>
#include <string>

namespace rt {

// Exit codes of every program of this project; others script against them.
enum class ExitCode : int {
    Done = 0,
    Failure = 1,   // render, device or output failure
    Usage = 2,     // flags and their values
    Input = 3,     // missing or invalid input: scene, asset, reference, checkpoint
    NoDevice = 4,  // no suitable device
    Different = 5, // images differ more than asked
    Interrupted = 130
};

// what() is one line naming the file or flag, the place, the value and what is allowed.
class Error : public std::runtime_error {
  public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

struct UsageError : Error {
    explicit UsageError(const std::string& message) : Error(ExitCode::Usage, message) {}
};
struct InputError : Error {
    explicit InputError(const std::string& message) : Error(ExitCode::Input, message) {}
};
struct RenderError : Error {
    explicit RenderError(const std::string& message) : Error(ExitCode::Failure, message) {}
};

// One line about any exception: for want of memory and for what std::filesystem throws in words of our own.
std::string messageOf(const std::exception& error);

} // namespace rt
