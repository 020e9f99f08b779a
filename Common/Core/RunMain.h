// The frame of every main(): errors become one line on standard error and the documented exit code.
#pragma once
#include <functional>

namespace rt {

// Runs `body`, whose result is the exit code unless it throws, or standard output cannot be written. Lines are
// "<program>: <message>", the message made printable.
int runMain(const char* program, const std::function<int()>& body);

} // namespace rt
