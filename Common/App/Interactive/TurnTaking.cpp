#include "Common/App/Interactive/TurnTaking.h"

#include <algorithm>

namespace rt::app {

std::optional<std::size_t> Turns::next(const std::vector<bool>& isWaiting) {
    isShared_ = std::count(isWaiting.begin(), isWaiting.end(), true) > 1;
    // What those have had least who have been waiting: who joins them begins there.
    std::optional<double> least;
    for (std::size_t i = 0; i < count(); ++i)
        if (isWaiting[i] && had_[i].wasWaiting) least = std::min(least.value_or(had_[i].seconds), had_[i].seconds);
    for (std::size_t i = 0; i < count(); ++i) {
        if (isWaiting[i] && !had_[i].wasWaiting && least) had_[i].seconds = std::max(had_[i].seconds, *least);
        had_[i].wasWaiting = isWaiting[i];
    }
    return leastServed(
        count(), [&](std::size_t i) { return isWaiting[i]; }, [&](std::size_t i) { return had_[i].seconds; });
}

} // namespace rt::app
