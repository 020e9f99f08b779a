// Which moment of which animation a scene is posed at, and for how long light is gathered.
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"

namespace rt::scene {

struct Moment {
    std::string animation = {}; // by name; empty: the first
    double time = 0;            // seconds
    bool isAsked = false;       // somebody has said so, be it the start of the first one, and need not be told of it
    bool isWhole = false; // it stands in place of a time that a scene file imports a model at, or comes after that
    friend bool operator==(const Moment& a, const Moment& b) {
        return a.animation == b.animation && a.time == b.time && a.isWhole == b.isWhole;
    }
};

// Of a model that a scene file imports at a moment of its own, where another one is asked for.
inline Moment momentOfImport(const Moment& own, Moment asked) {
    const bool isOfOwn = asked.animation.empty() || asked.animation == own.animation;
    if (!isOfOwn) return asked;
    asked.animation = own.animation;
    if (!asked.isWhole) asked.time += own.time;
    return asked;
}

// What moves in a scene, and how far it has got.
struct Motion {
    std::vector<std::string> animations = {}; // by name; none: nothing moves
    std::size_t chosen = 0;
    double length = 0; // of the chosen one, in seconds
    double time = 0;   // that the scene is posed at
    bool operator==(const Motion&) const = default;
};

// While light is gathered: seconds relative to the moment, which may lie anywhere.
struct Shutter {
    double open = 0, close = 0;
    bool operator==(const Shutter&) const = default;
    bool isOpen() const { return open < close; } // or the picture is of one instant
    double middle() const { return open + (close - open) / 2; }
};

// Which of a scene's animations is meant; none where there are none. Throws UsageError naming those that there are.
inline std::optional<std::size_t> chosenAnimation(const std::vector<std::string>& names, const Moment& moment) {
    if (moment.animation.empty()) return names.empty() ? std::nullopt : std::optional<std::size_t>(0);
    const auto found = std::find(names.begin(), names.end(), moment.animation);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    constexpr std::size_t kShown = 20;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) list += (i == 0 ? "" : ", ") + names[i];
    if (names.size() > kShown) list += " and " + std::to_string(names.size() - kShown) + " more";
    throw UsageError("--animation " + printable(moment.animation) + ": " +
                     (names.empty() ? "the scene has no animations" : "allowed is one of the scene's: " + list));
}

// Of a scene in which nothing moves: throws UsageError where an animation is asked for, and adds a notice where a time
// is.
inline void noticeStandstill(const Moment& moment, std::vector<std::string>& notices) {
    static_cast<void>(chosenAnimation({}, moment));
    if (moment.time != 0) notices.emplace_back("nothing moves in it: --time counts for nothing");
}

} // namespace rt::scene
