// How the light of a path was found: names in files, titles in windows.
#pragma once
#include <cstddef>
#include <cstdint>

#include "Common/Render/Names.h"

namespace rt::probe {

enum class Technique {
    Seen,           // from the camera, if at all by way of mirrors and glass alone
    Scattering,     // a direction that the bsdf sampled
    Mixture,        // or in its place the mixture
    BehindSpecular, // such a direction, then mirrors and glass, of which a shadow ray knows no way
    LightSampling,
    Connection,
    EdgeRay,
    SharedPath // of a neighbour
};

inline constexpr app::Named<Technique> kTechniques[] = {
    {"seen", Technique::Seen, "Light in sight", "seen from the camera, also in mirrors and through glass"},
    {"bsdf", Technique::Scattering, "BSDF sampling", "a direction that was sampled by the BSDF met the light"},
    {"mixture", Technique::Mixture, "Mixture sampling", "a direction that was sampled by the mixture met the light"},
    {"behind-specular", Technique::BehindSpecular, "BSDF, then glass or mirrors",
     "a direction that was sampled by the BSDF led by way of mirrors or glass to the light: light sampling has no part "
     "in it"},
    {"light-sampling", Technique::LightSampling, "Light sampling", "the light was chosen, and a point on it sampled"},
    {"connection", Technique::Connection, "Glass connection", "a light was connected to by way of a smooth sphere"},
    {"edge-ray", Technique::EdgeRay, "Edge ray", "one of several camera rays at the edge of a light"},
    {"shared-path", Technique::SharedPath, "Neighbour's path", "the path of a neighbouring pixel brought it"}};

// What stands for it in pictures: sRGB, of 255. They differ in brightness as well as in hue.
struct TechniqueColor {
    std::uint8_t r, g, b;
};
inline constexpr TechniqueColor kTechniqueColors[] = {{150, 150, 165}, {80, 160, 255}, {60, 200, 190},
                                                      {255, 80, 90},   {255, 170, 40}, {255, 120, 220},
                                                      {170, 230, 80},  {170, 120, 255}};
inline TechniqueColor colorOf(Technique technique) {
    return kTechniqueColors[static_cast<std::size_t>(technique)];
}

} // namespace rt::probe
