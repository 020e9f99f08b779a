#include "Common/Scene/Json/SkyJson.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "Common/Scene/Json/JsonWriting.h"
#include "Common/Scene/Json/SceneJson.h"

namespace rt::scene {

namespace {

// ---- reading -------------------------------------------------------------------------------------------------------

bool isTurn(const std::array<double, 9>& rows) {
    const glm::dmat3 map(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8]);
    const glm::dmat3 product = glm::transpose(map) * map;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (!(std::abs(product[c][r] - (c == r ? 1 : 0)) <= 1e-6)) return false;
    return true;
}

ImageBackground readSkyImage(const JsonNode& node, const SceneReferences& references) {
    node.expectKeys({"type", "file", "factor", "rotation", "projection", "orientation"});
    ImageBackground image;
    image.file = references.file(node.at("file"), false);
    if (const auto factor = node.find("factor")) image.factor = factor->vectorWithin(0, kLargest);
    if (const auto rotation = node.find("rotation")) image.rotation = rotation->number();
    if (const auto projection = node.find("projection"))
        if (projection->oneOf({"latitude-longitude", "pbrt"}) == "pbrt") image.projection = SkyProjection::Pbrt;
    if (const auto orientation = node.find("orientation")) {
        const std::vector<double> rows = orientation->numbers(9);
        if (rows.size() != image.orientation.size()) orientation->failValue("9 numbers: three rows of three");
        std::copy(rows.begin(), rows.end(), image.orientation.begin());
        if (!isTurn(image.orientation)) orientation->failValue("rows of unit length at right angles to each other");
    }
    return image;
}

SunSkyBackground readSunSky(const JsonNode& node) {
    node.expectKeys({"type", "sun_elevation", "sun_azimuth", "turbidity", "ground", "factor"});
    SunSkyBackground sky;
    if (const auto elevation = node.find("sun_elevation")) sky.sunElevation = elevation->within(0, 90);
    if (const auto azimuth = node.find("sun_azimuth")) sky.sunAzimuth = azimuth->number();
    if (const auto turbidity = node.find("turbidity"))
        sky.turbidity = turbidity->within(kLeastTurbidity, kMostTurbidity);
    if (const auto ground = node.find("ground")) sky.ground = ground->vectorWithin(0, 1);
    if (const auto factor = node.find("factor")) sky.factor = factor->vectorWithin(0, kLargest);
    return sky;
}

// ---- writing -------------------------------------------------------------------------------------------------------

struct SkyWriter {
    OrderedJson operator()(const ConstantBackground& sky) const {
        return {{"type", "constant"}, {"color", json(sky.color)}};
    }
    OrderedJson operator()(const GradientBackground& sky) const {
        return {{"type", "gradient"}, {"bottom", json(sky.bottom)}, {"top", json(sky.top)}};
    }
    OrderedJson operator()(const ImageBackground& sky) const {
        const ImageBackground usual;
        OrderedJson out = {{"type", "image"}, {"file", sky.file}};
        setUnless(out, "factor", sky.factor, usual.factor);
        setUnless(out, "rotation", sky.rotation, usual.rotation);
        if (sky.projection == SkyProjection::Pbrt) out["projection"] = "pbrt";
        setUnless(out, "orientation", sky.orientation, usual.orientation);
        return out;
    }
    OrderedJson operator()(const SunSkyBackground& sky) const {
        const SunSkyBackground usual;
        OrderedJson out = {{"type", "sun_sky"}, {"sun_elevation", sky.sunElevation}, {"sun_azimuth", sky.sunAzimuth}};
        setUnless(out, "turbidity", sky.turbidity, usual.turbidity);
        setUnless(out, "ground", sky.ground, usual.ground);
        setUnless(out, "factor", sky.factor, usual.factor);
        return out;
    }
};

} // namespace

Background readSky(const JsonNode& node, const SceneReferences& references) {
    const std::string type = node.at("type").oneOf({"constant", "gradient", "image", "sun_sky"});
    if (type == "image") return readSkyImage(node, references);
    if (type == "sun_sky") return readSunSky(node);
    if (type == "constant") {
        node.expectKeys({"type", "color"});
        return ConstantBackground{node.at("color").vectorWithin(0, kLargest)};
    }
    node.expectKeys({"type", "bottom", "top"});
    return GradientBackground{node.at("bottom").vectorWithin(0, kLargest), node.at("top").vectorWithin(0, kLargest)};
}

OrderedJson skyJson(const Background& sky) {
    return std::visit(SkyWriter{}, sky);
}

} // namespace rt::scene
