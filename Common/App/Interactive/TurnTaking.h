// Whose turn it is among those who share a device: by the time that each has had of it, as it was measured. There is no
// clock here.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

namespace rt::app {

// Of `count`, those that `isWaiting` says the one that has had least, by `seconds`; the first of several. None: nobody
// waits.
template <class IsWaiting, class Seconds>
std::optional<std::size_t> leastServed(std::size_t count, const IsWaiting& isWaiting, const Seconds& seconds) {
    std::optional<std::size_t> least;
    for (std::size_t i = 0; i < count; ++i)
        if (isWaiting(i) && (!least || seconds(i) < seconds(*least))) least = i;
    return least;
}

// Turns of those who come, go, and have nothing to do at times: who waits again, or is new, has no claim to what the
// others had meanwhile, and nobody owes what he had while he alone wanted it.
class Turns {
  public:
    void add() { had_.push_back({}); }
    void remove(std::size_t i) { had_.erase(had_.begin() + static_cast<std::ptrdiff_t>(i)); }
    std::size_t count() const { return had_.size(); }

    // Once for each turn. None: nobody waits.
    std::optional<std::size_t> next(const std::vector<bool>& isWaiting);
    void spend(std::size_t i, double seconds) { had_[i].seconds += isShared_ ? seconds : 0; }
    double seconds(std::size_t i) const { return had_[i].seconds; } // that it has had of others, or has no claim to

  private:
    struct Had {
        double seconds = 0;
        bool wasWaiting = false;
    };
    std::vector<Had> had_;
    bool isShared_ = false; // the turn at hand, which others wait for
};

} // namespace rt::app
