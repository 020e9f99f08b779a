// Several things to write, each of which may fail by itself.
#pragma once
#include <exception>
#include <string>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Core/MemoryReserve.h"

namespace rt::app {

// Runs `action`. A failure, want of memory included, becomes one line in `failures`; one that is no Error, and does not
// name the place, begins with `what`.
template <class Action>
bool attempt(std::vector<std::string>& failures, const std::string& what, const Action& action) {
    keepMemoryReserve(); // that the last action may have used
    try {
        action();
        return true;
    } catch (const Error& error) {
        failures.emplace_back(error.what());
    } catch (const std::exception& error) {
        failures.push_back(what + ": " + messageOf(error));
    }
    return false;
}

} // namespace rt::app
