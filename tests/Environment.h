// Variables of the test's own environment.
#pragma once
#include <cstdlib>
#include <string>

namespace rt::test {

// An empty value takes the variable away.
inline void setVariable(const char* name, const std::string& value) {
#ifdef _WIN32
    _putenv_s(name, value.c_str());
#else
    if (value.empty())
        unsetenv(name);
    else
        setenv(name, value.c_str(), 1);
#endif
}

} // namespace rt::test
