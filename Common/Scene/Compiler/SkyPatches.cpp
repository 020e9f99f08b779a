#include "Common/Scene/Compiler/SkyPatches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Shared/Light/Sky.h"

namespace rt::scene {

namespace {

constexpr std::size_t kMaxPatches = 4;
constexpr double kMinNoise = 0.05; // of the sky's; a patch with less is not worth a place in the list
constexpr double kDark = 0.1;      // of a patch's greatest radiance

// Texels as they are sampled, row by row.
class SkyTexels {
  public:
    explicit SkyTexels(const CompiledScene& scene)
        : scene_(scene),
          image_(scene.images[scene.globals.skyImage]),
          irradiance_(4 * std::numbers::pi * luminance(scene.lights[scene.globals.skyLight].emission)) {
        const double step = std::numbers::pi / image_.height;
        for (std::uint32_t y = 0; y < image_.height; ++y) {
            solidAngles_.push_back(2 * std::numbers::pi / image_.width *
                                   (std::cos(y * step) - std::cos((y + 1) * step)));
            rows_.push_back(cosineAndSineOf((y + 0.5) * step));
        }
        for (std::uint32_t x = 0; x < image_.width; ++x)
            columns_.push_back(cosineAndSineOf(2 * std::numbers::pi * (x + 0.5) / image_.width));
    }

    std::uint32_t width() const { return image_.width; }
    std::uint32_t height() const { return image_.height; }
    double irradiance() const { return irradiance_; } // of all
    double irradiance(std::uint32_t x, std::uint32_t y) const {
        const std::size_t column = shared::skyColumns(image_, y) + x;
        return irradiance_ * widthAt(y) * widthAt(column);
    }
    double radiance(std::uint32_t x, std::uint32_t y) const { return irradiance(x, y) / solidAngles_[y]; }

    // In the image's frame: of a texel's middle, and of its upper left corner.
    glm::dvec3 middle(std::uint32_t x, std::uint32_t y) const { return directionOf(rows_[y], columns_[x]); }
    glm::dvec3 corner(std::uint32_t x, std::uint32_t y) const {
        return directionOf(cosineAndSineOf(std::numbers::pi * y / height()),
                           cosineAndSineOf(2 * std::numbers::pi * x / width()));
    }
    shared::vec3 toWorld(const glm::dvec3& direction) const {
        return shared::fromSkyImage(scene_.globals, shared::vec3(direction));
    }

  private:
    static glm::dvec2 cosineAndSineOf(double angle) { return {std::cos(angle), std::sin(angle)}; }
    static glm::dvec3 directionOf(const glm::dvec2& polar, const glm::dvec2& azimuth) {
        return {-polar.y * azimuth.x, polar.x, -polar.y * azimuth.y};
    }
    double widthAt(std::size_t i) const {
        return static_cast<double>(scene_.skyCdf[i + 1]) - static_cast<double>(scene_.skyCdf[i]);
    }

    const CompiledScene& scene_;
    const shared::Image& image_;
    const double irradiance_;
    std::vector<double> solidAngles_;        // of a texel, by row
    std::vector<glm::dvec2> rows_, columns_; // cosine and sine of the angles of their middle
};

bool overlap(const shared::SkyPatch& a, const shared::SkyPatch& b) {
    return a.begin.x < b.end.x && b.begin.x < a.end.x && a.begin.y < b.end.y && b.begin.y < a.end.y;
}

shared::SkyPatch texelAt(std::uint32_t x, std::uint32_t y) {
    return {{x, y}, {x + 1, y + 1}};
}

template <typename Visit>
void forEachTexel(const shared::SkyPatch& patch, const Visit& visit) {
    for (std::uint32_t y = patch.begin.y; y < patch.end.y; ++y)
        for (std::uint32_t x = patch.begin.x; x < patch.end.x; ++x) visit(x, y);
}

class PatchFinder {
  public:
    explicit PatchFinder(const CompiledScene& scene) : texels_(scene) {}

    BrightSky find() {
        BrightSky sky;
        sky.irradiance = texels_.irradiance();
        double noise = 0;
        forEachTexel(all(), [&](auto x, auto y) { noise += texels_.irradiance(x, y) * texels_.radiance(x, y); });
        for (std::size_t i = 0; i < kMaxPatches; ++i) {
            const shared::SkyPatch brightest = brightestTexel();
            if (!isFree(brightest) || !(texels_.radiance(brightest.begin.x, brightest.begin.y) > 0)) break;
            const BrightPatch patch = measured(grown(brightest));
            taken_.push_back(patch.texels);
            if (patch.irradiance * patch.radiance >= kMinNoise * noise) sky.patches.push_back(patch);
        }
        return sky;
    }

  private:
    shared::SkyPatch all() const { return {{0, 0}, {texels_.width(), texels_.height()}}; }

    bool isFree(const shared::SkyPatch& patch) const {
        return std::ranges::none_of(taken_, [&](const shared::SkyPatch& other) { return overlap(patch, other); });
    }

    // Of those that are free; if none is, of all.
    shared::SkyPatch brightestTexel() const {
        shared::SkyPatch brightest = texelAt(0, 0);
        double maximum = -1;
        forEachTexel(all(), [&](auto x, auto y) {
            const double radiance = texels_.radiance(x, y);
            if (radiance <= maximum || !isFree(texelAt(x, y))) return;
            maximum = radiance;
            brightest = texelAt(x, y);
        });
        return brightest;
    }

    // Rows and columns are added on all sides until each is dark.
    shared::SkyPatch grown(shared::SkyPatch patch) const {
        const double minimum = kDark * texels_.radiance(patch.begin.x, patch.begin.y);
        for (bool grows = true; grows;) {
            grows = false;
            for (const int axis : {0, 1}) {
                shared::SkyPatch before = patch, behind = patch;
                before.end[axis] = patch.begin[axis];
                before.begin[axis] -= std::min(patch.begin[axis], 1u);
                behind.begin[axis] = patch.end[axis];
                behind.end[axis] = std::min(patch.end[axis] + 1, all().end[axis]);
                const bool growsBefore = isFree(before) && isBright(before, minimum);
                const bool growsBehind = isFree(behind) && isBright(behind, minimum);
                if (growsBefore) patch.begin[axis] = before.begin[axis];
                if (growsBehind) patch.end[axis] = behind.end[axis];
                grows = grows || growsBefore || growsBehind;
            }
        }
        return patch;
    }

    bool isBright(const shared::SkyPatch& strip, double minimum) const {
        bool isBright = false;
        forEachTexel(strip, [&](auto x, auto y) { isBright = isBright || texels_.radiance(x, y) >= minimum; });
        return isBright;
    }

    BrightPatch measured(const shared::SkyPatch& texels) const {
        BrightPatch patch;
        patch.texels = texels;
        glm::dvec3 sum(0);
        double noise = 0;
        forEachTexel(texels, [&](auto x, auto y) {
            const double irradiance = texels_.irradiance(x, y);
            patch.irradiance += irradiance;
            noise += irradiance * texels_.radiance(x, y);
            sum += irradiance * texels_.middle(x, y);
        });
        patch.radiance = noise / patch.irradiance;
        const glm::dvec3 axis = glm::length(sum) > 0 ? glm::normalize(sum) : glm::dvec3(0, 1, 0);
        double minimum = 1;
        const auto reach = [&](auto x, auto y) { minimum = std::min(minimum, glm::dot(axis, texels_.corner(x, y))); };
        for (std::uint32_t x = texels.begin.x; x <= texels.end.x; ++x) {
            reach(x, texels.begin.y);
            reach(x, texels.end.y);
        }
        for (std::uint32_t y = texels.begin.y; y <= texels.end.y; ++y) {
            reach(texels.begin.x, y);
            reach(texels.end.x, y);
        }
        patch.axis = texels_.toWorld(axis);
        patch.angle = std::acos(std::max(minimum, -1.0));
        return patch;
    }

    const SkyTexels texels_;
    std::vector<shared::SkyPatch> taken_;
};

} // namespace

BrightSky findBrightSky(const CompiledScene& scene) {
    if (scene.globals.skyLight == shared::kNone) return {};
    return PatchFinder(scene).find();
}

} // namespace rt::scene
