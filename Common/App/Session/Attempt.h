// Several things to write, each of which may fail by itself.
#pragma once
#include <new>
#include <string>
#include <vector>

#include "Common/Core/Error.h"

namespace rt::app {

// Runs `action`. A failure, want of memory included, becomes one line in `failures`; that of memory begins with `what`.
template <class Action>
bool attempt(std::vector<std::string>& failures, const std::string& what, const Action& action) {
    try {
        action();
        return true;
    } catch (const Error& error) {
        failures.emplace_back(error.what());
    } catch (const std::bad_alloc&) {
        failures.push_back(what + ": not enough memory");
    }
    return false;
}

} // namespace rt::app
