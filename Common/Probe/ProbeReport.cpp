#include "Common/Probe/ProbeReport.h"

#include "Common/Image/ImageIo.h"
#include "Common/Probe/ProbePicture.h"

namespace rt::probe {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const shared::vec3& v) {
    return {v.x, v.y, v.z};
}

// Of all samples.
Json testJson(const ProbeResult& result) {
    if (result.tests.empty() || !result.tests.back().test.cells) return nullptr;
    const DensityTest& test = result.tests.back().test;
    return {{"statistic", test.cells->statistic},
            {"degrees", test.cells->degrees},
            {"p", test.cells->p},
            {"resolved", test.isResolved()}};
}

Json growthJson(const std::vector<TestOf>& tests) {
    Json growth = Json::array();
    for (const TestOf& test : tests)
        if (test.test.cells) growth.push_back({test.samples, test.test.cells->p});
    return growth;
}

Json estimatesJson(const std::vector<EstimateOf>& estimates) {
    Json all = Json::object();
    for (const EstimateOf& e : estimates)
        all[e.name] = {{"mean", e.mean}, {"variance", e.variance}, {"exact", e.isExact()}};
    return all;
}

Json selectionJson(const std::vector<LightShare>& selection) {
    Json lights = Json::array();
    for (const LightShare& share : selection) lights.push_back({share.light, share.probability});
    return lights;
}

} // namespace

Json figuresOf(const ProbeResult& result, const std::string& scene, const std::array<std::uint32_t, 2>& pixel) {
    const ProbeSettings& settings = result.settings;
    return {{"version", 1},
            {"scene", scene},
            {"pixel", {pixel[0], pixel[1]}},
            {"strategy", nameOf(settings.strategy)},
            {"show", app::nameOf(kQuantities, settings.quantity)},
            {"sampler", app::nameOf(kProbeSamplers, settings.numbers.kind)},
            {"position", numbers(result.position)},
            {"normal", numbers(result.normal)},
            {"material", result.material},
            {"lights", result.lights},
            {"selection", selectionJson(result.selection)},
            {"integral", result.density.integral()},
            {"integral_error", result.density.integralError()},
            {"samples", result.samples},
            {"dropped", result.dropped},
            {"total_p", result.tests.empty() ? Json() : Json(result.tests.back().test.total)},
            {"chi_square", testJson(result)},
            {"chi_square_growth", growthJson(result.tests)},
            {"estimates", estimatesJson(result.estimates)}};
}

void writePicture(const std::string& file, const ProbeResult& result) {
    image::writeImage(file, image::isDisplayReferred(file) ? pictureOf(result) : imageOf(result.maps.front()));
}

} // namespace rt::probe
