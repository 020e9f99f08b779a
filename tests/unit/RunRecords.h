// Records of runs, for tests of what compares them.
#pragma once
#include <cstdint>
#include <string>

#include "Common/App/Interactive/RunHistory.h"

namespace rt::test {

// Of a program, with the default methods but for the estimator. Nothing that comparing its work needs is missing.
inline app::RunRecord runRecord(const std::string& program, const std::string& estimator, std::uint64_t spp) {
    app::RunRecord r;
    r.app = program;
    r.scene = "a";
    r.sceneHash = "0123456789abcdef";
    r.camera = R"({"look_from":[0,0,1]})";
    r.lightSampling = estimator;
    r.sampler = "sobol";
    r.lightSelection = "contribution";
    r.sphereLight = r.quadLight = r.triangleLight = "auto";
    r.russianRoulette = r.oneSidedLights = "on";
    r.adaptive = r.specularConnections = r.edgeRays = r.pathReuse = "off";
    r.width = r.height = 8;
    r.spp = spp;
    return r;
}

} // namespace rt::test
