#include "Common/Scene/Pbrt/PbrtSpectrum.h"

#include <algorithm>
#include <iterator>

namespace rt::scene {

namespace {

struct MeasuredIndex {
    double nm, n, k;
};

// P. B. Johnson and R. W. Christy, Optical Constants of the Noble Metals, Phys. Rev. B 6, 1972.
constexpr MeasuredIndex kSilver[] = {
    {367.9, 0.07, 1.657}, {381.5, 0.05, 1.864}, {397.4, 0.05, 2.070}, {413.3, 0.05, 2.275},
    {430.5, 0.04, 2.462}, {450.9, 0.04, 2.657}, {471.4, 0.05, 2.869}, {495.9, 0.05, 3.093},
    {520.9, 0.05, 3.324}, {548.6, 0.06, 3.586}, {582.1, 0.05, 3.858}, {616.8, 0.06, 4.152},
    {659.5, 0.05, 4.483}, {704.5, 0.04, 4.838}, {756.0, 0.03, 5.242}, {821.1, 0.04, 5.727}};
constexpr MeasuredIndex kGold[] = {
    {367.9, 1.48, 1.895}, {381.5, 1.46, 1.933}, {397.4, 1.47, 1.952}, {413.3, 1.46, 1.958},
    {430.5, 1.45, 1.948}, {450.9, 1.38, 1.914}, {471.4, 1.31, 1.849}, {495.9, 1.04, 1.833},
    {520.9, 0.62, 2.081}, {548.6, 0.43, 2.455}, {582.1, 0.29, 2.863}, {616.8, 0.21, 3.272},
    {659.5, 0.14, 3.697}, {704.5, 0.13, 4.103}, {756.0, 0.14, 4.542}, {821.1, 0.16, 5.083}};
constexpr MeasuredIndex kCopper[] = {
    {367.9, 1.36, 1.975}, {381.5, 1.33, 2.045}, {397.4, 1.32, 2.116}, {413.3, 1.28, 2.207},
    {430.5, 1.25, 2.305}, {450.9, 1.24, 2.397}, {471.4, 1.25, 2.483}, {495.9, 1.22, 2.564},
    {520.9, 1.18, 2.608}, {548.6, 1.02, 2.577}, {582.1, 0.70, 2.704}, {616.8, 0.30, 3.205},
    {659.5, 0.22, 3.747}, {704.5, 0.21, 4.205}, {756.0, 0.24, 4.665}, {821.1, 0.26, 5.180}};
// A. D. Rakic, Algorithm for the Determination of Intrinsic Optical Constants of Metal Films, Appl. Opt. 34, 1995.
constexpr MeasuredIndex kAluminium[] = {{364.66, 0.39877, 4.3957}, {413.28, 0.52135, 5.0008}, {442.80, 0.60790, 5.3676},
                                        {476.87, 0.72780, 5.7781}, {516.60, 0.87340, 6.2418}, {563.57, 1.0728, 6.7839},
                                        {619.93, 1.3660, 7.4052},  {652.25, 1.5724, 7.7354},  {688.81, 1.8301, 8.0601},
                                        {729.32, 2.1606, 8.3565},  {774.91, 2.6154, 8.4914},  {815.69, 2.7668, 8.2573}};
// M. R. Querry, Optical Constants, Contractor Report CRDC-CR-85034, 1985: 70 % copper, 30 % zinc.
constexpr MeasuredIndex kBrass[] = {{360, 1.503, 1.815}, {380, 1.487, 1.818}, {400, 1.445, 1.805}, {420, 1.350, 1.786},
                                    {440, 1.191, 1.797}, {460, 0.994, 1.883}, {480, 0.816, 2.046}, {500, 0.686, 2.250},
                                    {520, 0.602, 2.464}, {540, 0.549, 2.668}, {560, 0.505, 2.860}, {580, 0.468, 3.059},
                                    {600, 0.450, 3.253}, {620, 0.449, 3.434}, {640, 0.444, 3.609}, {660, 0.445, 3.778},
                                    {680, 0.444, 3.943}, {700, 0.446, 4.106}, {740, 0.455, 4.424}, {800, 0.473, 4.890}};

struct NamedMetal {
    std::string_view name;
    const MeasuredIndex *first, *last;
};
const NamedMetal kNamedMetals[] = {{"Ag", std::begin(kSilver), std::end(kSilver)},
                                   {"Al", std::begin(kAluminium), std::end(kAluminium)},
                                   {"Au", std::begin(kGold), std::end(kGold)},
                                   {"Cu", std::begin(kCopper), std::end(kCopper)},
                                   {"CuZn", std::begin(kBrass), std::end(kBrass)}};

// Of the makers' data sheets. pbrt's F5, F10 and F11 are the dense flints of the names with SF.
constexpr std::pair<std::string_view, double> kNamedGlasses[] = {
    {"BK7", 1.5168}, {"BAF10", 1.6700}, {"FK51A", 1.4866}, {"LASF9", 1.8503}, {"F5", 1.6727},
    {"F10", 1.7283}, {"F11", 1.7847},   {"SF5", 1.6727},   {"SF10", 1.7283},  {"SF11", 1.7847}};

} // namespace

const char* const kPbrtMetals = "Ag, Al, Au, Cu, CuZn";
const char* const kPbrtGlasses = "BK7, BAF10, FK51A, LASF9, F5, F10, F11, SF5, SF10, SF11";

double PbrtSpectrum::at(double nm) const {
    const auto isBelow = [](const std::pair<double, double>& sample, double wavelength) {
        return sample.first < wavelength;
    };
    const auto above = std::lower_bound(samples.begin(), samples.end(), nm, isBelow);
    if (above == samples.end()) return 0;
    if (above->first == nm) return above->second;
    if (above == samples.begin()) return 0;
    const auto below = std::prev(above);
    const double share = (nm - below->first) / (above->first - below->first);
    return below->second + share * (above->second - below->second);
}

std::optional<PbrtSpectrum> pbrtMetal(std::string_view name) {
    constexpr std::string_view kBegin = "metal-", kEta = "-eta", kAbsorption = "-k";
    if (!name.starts_with(kBegin)) return std::nullopt;
    const bool isEta = name.ends_with(kEta);
    if (!isEta && !name.ends_with(kAbsorption)) return std::nullopt;
    name.remove_prefix(kBegin.size());
    name.remove_suffix(isEta ? kEta.size() : kAbsorption.size());
    for (const NamedMetal& metal : kNamedMetals) {
        if (metal.name != name) continue;
        PbrtSpectrum spectrum;
        for (const MeasuredIndex* entry = metal.first; entry != metal.last; ++entry)
            spectrum.samples.emplace_back(entry->nm, isEta ? entry->n : entry->k);
        return spectrum;
    }
    return std::nullopt;
}

std::optional<double> pbrtGlass(std::string_view name) {
    constexpr std::string_view kBegin = "glass-";
    if (!name.starts_with(kBegin)) return std::nullopt;
    name.remove_prefix(kBegin.size());
    for (const auto& [glass, index] : kNamedGlasses)
        if (glass == name) return index;
    return std::nullopt;
}

} // namespace rt::scene
