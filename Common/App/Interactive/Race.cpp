#include "Common/App/Interactive/Race.h"

#include <algorithm>
#include <cmath>

#include "Common/App/Interactive/TurnTaking.h"
#include "Common/Core/Format.h"
#include "Common/Render/Names.h"

namespace rt::app {
namespace {

constexpr double kLookGrowth = 1.2;         // of an entrant's time, from one look to the next;
constexpr double kDenoisedLookGrowth = 1.5; // of pictures that are filtered for each look
constexpr double kLevel = 1.05;             // a smaller factor is none

void addToName(std::string& name, const std::string& part) {
    name += (name.empty() ? "" : ", ") + part;
}

// After that time; of a curve that begins later as far as it is when error x time stays what it is at its end. 0: there
// is no curve.
double errorBy(const std::vector<ErrorPoint>& curve, double seconds) {
    if (curve.empty()) return 0;
    return errorAt(curve, seconds).value_or(curve.back().relmse * curve.back().seconds / seconds);
}

// How much more time than the leader the entrant takes to the error that it has; none where the leader's curve does not
// tell when it had that.
std::optional<double> timeFactor(const std::vector<RaceLane>& lanes, const RaceStanding& standing,
                                 std::size_t entrant) {
    const std::optional<double> error = errorAt(lanes[entrant].curve, standing.seconds);
    const auto seconds = error ? secondsTo(lanes[standing.leader].curve, *error) : std::nullopt;
    return seconds && *seconds > 0 ? std::optional(standing.seconds / *seconds) : std::nullopt;
}

std::string threeDigits(double value) {
    return formatted(value < 1000 ? "%.3g" : "%.0f", value);
}

} // namespace

std::vector<std::string> namesOf(const std::vector<RaceEntrant>& entrants, bool isGpu, const std::string& noun) {
    std::vector<std::string> names(entrants.size());
    const auto differ = [&entrants](auto value) {
        return std::any_of(entrants.begin(), entrants.end(),
                           [&](const RaceEntrant& e) { return value(e) != value(entrants.front()); });
    };
    if (differ([](const RaceEntrant& e) { return e.isOther; }))
        for (std::size_t i = 0; i < names.size(); ++i) names[i] = entrants[i].isOther == isGpu ? "CPU" : "GPU";
    // Whether a method differs is known when all have been seen: titles by method, then by entrant.
    std::vector<std::vector<std::string>> titles;
    for (const RaceEntrant& entrant : entrants) {
        std::vector<std::string> own;
        const auto add = [&own](const char*, const char* title, const char*, const auto& table, const auto& value) {
            const std::string name = titleOf(table, value);
            own.push_back(name == "On" || name == "Off" || name == "Auto" ? title + std::string(" ") + name : name);
        };
        forEachMethod(add, entrant.settings);
        titles.push_back(std::move(own));
    }
    for (std::size_t method = 0; !titles.empty() && method < titles.front().size(); ++method) {
        const auto isOther = [&](const auto& own) { return own[method] != titles.front()[method]; };
        if (std::none_of(titles.begin(), titles.end(), isOther)) continue;
        for (std::size_t i = 0; i < names.size(); ++i) addToName(names[i], titles[i][method]);
    }
    if (differ([](const RaceEntrant& e) { return e.isDenoised; }))
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (entrants[i].isDenoised)
                addToName(names[i], "denoised");
            else if (names[i].empty())
                names[i] = "raw";
        }
    const std::vector<std::string> alike = names;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].empty() || std::count(alike.begin(), alike.end(), alike[i]) > 1)
            names[i] = noun + " " + std::to_string(i + 1) + (alike[i].empty() ? "" : " (" + alike[i] + ")");
    return names;
}

Race::Race(const RaceRequest& request, bool isGpu) : looks_(request.entrants.size()), seconds_(request.seconds) {
    const std::vector<std::string> names = namesOf(request.entrants, isGpu);
    for (std::size_t i = 0; i < names.size(); ++i) {
        lanes_.emplace_back();
        lanes_.back().entrant = request.entrants[i];
        lanes_.back().name = names[i];
    }
}

std::optional<std::size_t> Race::next() const {
    const auto isWaiting = [this](std::size_t i) {
        return !lanes_[i].entrant.isOther && !lanes_[i].isOut && secondsLeft(i) > 0;
    };
    return leastServed(lanes_.size(), isWaiting, [this](std::size_t i) { return lanes_[i].seconds; });
}

double Race::secondsLeft(std::size_t entrant) const {
    return std::max(0.0, seconds_ - lanes_[entrant].seconds);
}

void Race::spend(std::size_t entrant, double seconds) {
    lanes_[entrant].seconds = seconds;
}

bool Race::isLookDue(std::size_t entrant) const {
    const RaceLane& lane = lanes_[entrant];
    if (lane.isOut || !(lane.seconds > looks_[entrant])) return false;
    const double growth = lane.entrant.isDenoised ? kDenoisedLookGrowth : kLookGrowth;
    return lane.seconds >= seconds_ || lane.seconds >= growth * looks_[entrant];
}

void Race::look(std::size_t entrant, std::optional<ErrorPoint> point) {
    RaceLane& lane = lanes_[entrant];
    looks_[entrant] = lane.seconds;
    const bool isLater = lane.curve.empty() || (point && point->seconds > lane.curve.back().seconds);
    if (point && isLater) lane.curve.push_back(*point);
    if (lane.seconds >= seconds_) finish(entrant);
}

void Race::finish(std::size_t entrant) {
    RaceLane& lane = lanes_[entrant];
    lane.isOut = true;
    if (lane.curve.empty()) lane.trouble = "no whole picture within its " + threeDigits(seconds_) + " s";
}

void Race::drop(std::size_t entrant, const std::string& why) {
    lanes_[entrant].isOut = true;
    lanes_[entrant].trouble = why;
}

void Race::end() {
    for (RaceLane& lane : lanes_) lane.isOut = true;
}

bool Race::isOver() const {
    return std::all_of(lanes_.begin(), lanes_.end(), [](const RaceLane& lane) { return lane.isOut; });
}

std::optional<RaceStanding> standingOf(const std::vector<RaceLane>& lanes) {
    RaceStanding standing;
    standing.seconds = 1e300;
    for (const RaceLane& lane : lanes)
        if (!lane.curve.empty()) standing.seconds = std::min(standing.seconds, lane.curve.back().seconds);
    std::vector<std::pair<double, std::size_t>> errors;
    for (std::size_t i = 0; i < lanes.size(); ++i)
        if (const double error = errorBy(lanes[i].curve, standing.seconds); error > 0) errors.emplace_back(error, i);
    if (errors.size() < 2) return std::nullopt;
    std::sort(errors.begin(), errors.end());
    standing.leader = errors[0].second;
    standing.second = errors[1].second;
    standing.factor = *factorOf(lanes, standing, standing.second);
    standing.isByTime = timeFactor(lanes, standing, standing.second).has_value();
    return standing;
}

std::optional<double> factorOf(const std::vector<RaceLane>& lanes, const RaceStanding& standing, std::size_t entrant) {
    if (entrant == standing.leader) return 1;
    const double error = errorBy(lanes[entrant].curve, standing.seconds);
    const double best = errorBy(lanes[standing.leader].curve, standing.seconds);
    if (!(error > 0) || !(best > 0)) return std::nullopt;
    return std::max(1.0, timeFactor(lanes, standing, entrant).value_or(error / best));
}

std::string headlineOf(const std::vector<RaceLane>& lanes, const RaceStanding& standing) {
    const std::string &leader = lanes[standing.leader].name, &second = lanes[standing.second].name;
    const std::string when = " after " + threeDigits(standing.seconds) + " s";
    if (standing.factor < kLevel) return leader + " and " + second + " are level" + when;
    const std::string factor = threeDigits(standing.factor);
    if (standing.isByTime) return leader + " leads: same error in 1/" + factor + " of the time of " + second;
    return leader + " leads: error \u00d7 time 1/" + factor + " of that of " + second;
}

} // namespace rt::app
