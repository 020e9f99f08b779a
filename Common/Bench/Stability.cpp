#include "Common/Bench/Stability.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>

#include <glm/geometric.hpp>

#include "Common/Core/Format.h"
#include "Common/Render/FilmEstimate.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"

namespace rt::bench {

namespace {

using glm::dvec3;
using namespace rt::scene;

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kSide = 16;
constexpr std::uint32_t kReplicates = 32;

// ---- scenes --------------------------------------------------------------------------------------------------------

SceneDesc seenFrom(const dvec3& from, const dvec3& at, double fov) {
    SceneDesc desc;
    desc.id = "stability";
    desc.camera.lookFrom = from;
    desc.camera.lookAt = at;
    desc.camera.up = std::abs(at.x - from.x) + std::abs(at.z - from.z) > 1e-9 ? dvec3(0, 1, 0) : dvec3(0, 0, 1);
    desc.camera.verticalFov = fov;
    return desc;
}

void addMaterial(SceneDesc& desc, const char* name, MaterialKind kind, double albedo, double emission = 0) {
    MaterialDesc material;
    material.kind = kind;
    material.albedo = dvec3(albedo);
    material.emission = dvec3(emission);
    material.sides = Sides::Both;
    desc.materials[name] = material;
}

// A convex body of albedo 1/2 under a sky of 1: its radiance is 1/2, and 1/4 and less where a ray met it again.
SceneDesc convexBody(const ObjectDesc& body, const dvec3& from, const dvec3& at, double fov) {
    SceneDesc desc = seenFrom(from, at, fov);
    desc.background = ConstantBackground{dvec3(1)};
    addMaterial(desc, "body", MaterialKind::Lambertian, 0.5);
    desc.objects.push_back(body);
    return desc;
}

// A floor at y = 0 seen at the origin, lit by what the caller adds.
SceneDesc litFloor() {
    SceneDesc desc = seenFrom({0.05, 0.6, 0.6}, {0, 0, 0}, 1e-4);
    addMaterial(desc, "floor", MaterialKind::Lambertian, 0.7);
    addMaterial(desc, "light", MaterialKind::Emitter, 0, 2);
    desc.objects.push_back({QuadDesc{{-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, "floor"}});
    return desc;
}

// Of a point with normal +y under a polygon of radiance 1 that is wholly above it (Lambert).
double irradianceOf(const std::vector<dvec3>& polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 a = glm::normalize(polygon[i]), b = glm::normalize(polygon[(i + 1) % polygon.size()]);
        const dvec3 n = glm::cross(a, b);
        if (glm::length(n) > 0) sum += std::atan2(glm::length(n), glm::dot(a, b)) * n.y / glm::length(n);
    }
    return 0.5 * std::abs(sum);
}

// Balls, a box and glass in a room with a lamp: something of everything, in metres.
SceneDesc stillLife(double scale, const dvec3& shift) {
    const auto at = [&](const dvec3& p) { return p * scale + shift; };
    SceneDesc desc = seenFrom(at({0.3, 1.1, 4}), at({0, 0.6, 0}), 40);
    addMaterial(desc, "wall", MaterialKind::Lambertian, 0.6);
    addMaterial(desc, "glass", MaterialKind::Dielectric, 1);
    addMaterial(desc, "metal", MaterialKind::Metal, 0.8);
    addMaterial(desc, "lamp", MaterialKind::Emitter, 0, 6);
    const auto quad = [&](const dvec3& corner, const dvec3& u, const dvec3& v, const char* material) {
        desc.objects.push_back({QuadDesc{at(corner), u * scale, v * scale, material}});
    };
    quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, "wall");
    quad({-3, 0, -3}, {6, 0, 0}, {0, 4, 0}, "wall");
    quad({-0.5, 2.5, -0.5}, {1, 0, 0}, {0, 0, 1}, "lamp");
    for (const auto& [center, material] :
         {std::pair(dvec3(-0.9, 0.5, 0.25), "glass"), std::pair(dvec3(0.25, 0.5, -0.75), "wall"),
          std::pair(dvec3(1.25, 0.5, 0.5), "metal")}) {
        SphereDesc ball;
        ball.center = at(center), ball.radius = 0.5 * scale, ball.material = material;
        desc.objects.push_back({ball});
    }
    return desc;
}

// ---- measurements --------------------------------------------------------------------------------------------------

struct Rendered {
    double mean = 0; // over pixels and channels
    double standardError = 0;
    std::uint64_t nonfinite = 0;
    image::Image image;
};

class StabilitySuite {
  public:
    StabilitySuite(app::Engine& engine, const StabilityOptions& options) : engine_(engine), options_(options) {}

    std::vector<StabilityRow> run() {
        scale();
        translation();
        radii();
        accumulation();
        grazing();
        slivers();
        coincident();
        nestedGlass();
        media();
        furnaces();
        return rows_;
    }

  private:
    Rendered render(const std::shared_ptr<const CompiledScene>& compiled, std::uint32_t spp,
                    const app::RenderSettings& base = {}, std::uint32_t side = kSide) {
        app::RenderSettings settings = base;
        settings.width = settings.height = side;
        settings.spp = spp;
        settings.replicates = std::min(kReplicates, spp);
        engine_.setScene(compiled, nullptr);
        engine_.reset(compiled->camera, settings);
        while (!engine_.renderSome({std::chrono::seconds(1), nullptr}).finished) {
        }
        Rendered r;
        const app::FilmEstimate estimate = app::estimate(engine_.film(), app::dependentSide(engine_.report().features));
        for (std::size_t c = 0; c < 3; ++c) {
            r.mean += estimate.meanRadiance[c] / 3;
            if (estimate.standardError) r.standardError = std::max(r.standardError, (*estimate.standardError)[c]);
        }
        r.image = engine_.film().resolve();
        r.nonfinite = engine_.report().nonfiniteSamples;
        return r;
    }
    Rendered render(const SceneDesc& desc, std::uint32_t spp, const app::RenderSettings& base = {},
                    std::uint32_t side = kSide) {
        return render(compileScene(desc), spp, base, side);
    }

    void add(const std::string& name, double value, const std::string& criterion, bool pass) {
        rows_.push_back({name, engine_.report().engine, value, criterion, pass});
        if (options_.measured) options_.measured(rows_.back());
    }

    // Mean against the exact answer, with an allowance for what rounding or a limit of depth takes away.
    void addMean(const std::string& name, const Rendered& r, double exact, double allowance = 1e-5) {
        const double off = std::abs(r.mean - exact);
        const bool pass = r.nonfinite == 0 && off <= 4 * r.standardError + allowance * std::abs(exact);
        add(name, r.mean / exact - 1, "within 4 standard errors + " + formatted("%.0e", allowance) + " of 0", pass);
    }

    static double differingPixels(const image::Image& a, const image::Image& b) {
        std::size_t differing = 0;
        for (std::size_t i = 0; i < a.data.size(); i += 3)
            differing += !std::equal(a.data.begin() + static_cast<std::ptrdiff_t>(i),
                                     a.data.begin() + static_cast<std::ptrdiff_t>(i + 3),
                                     b.data.begin() + static_cast<std::ptrdiff_t>(i));
        return static_cast<double>(differing);
    }

    // A device's own traversal may order equal hits otherwise, so there a few pixels may differ.
    double tolerated() const {
        const std::string engine = engine_.report().engine;
        return engine == "single" || engine == "multi" ? 0 : 0.02 * kSide * kSide;
    }

    // All lengths times a power of two: no bit may change. Times 1e-4 and 1e4: the same mean.
    void scale() {
        const Rendered original = render(stillLife(1, dvec3(0)), 64);
        for (const int power : {-20, -13, 13, 20}) {
            const Rendered scaled = render(stillLife(std::exp2(power), dvec3(0)), 64);
            const double differing = differingPixels(original.image, scaled.image);
            add("scale 2^" + std::to_string(power), differing, "differing pixels <= " + formatted("%.0f", tolerated()),
                scaled.nonfinite == 0 && differing <= tolerated());
        }
        for (const double factor : {1e-4, 1e4})
            compareMeans("scale " + formatted("%.0e", factor), stillLife(factor, dvec3(0)), original);
    }

    // A scene and its camera far from the origin, where coordinates keep all their digits: no bit may change.
    void translation() {
        const Rendered original = render(stillLife(1, dvec3(0)), 64);
        for (const double distance : {131072.0, 1048576.0}) {
            const Rendered moved = render(stillLife(1, dvec3(distance, -distance, distance)), 64);
            const double differing = differingPixels(original.image, moved.image);
            add("translation " + formatted("%.0f", distance), differing,
                "differing pixels <= " + formatted("%.0f", tolerated()),
                moved.nonfinite == 0 && differing <= tolerated());
        }
        compareMeans("translation 1e6", stillLife(1, dvec3(1e6, 1e6, -1e6)), original);
    }

    void compareMeans(const std::string& name, const SceneDesc& desc, const Rendered& original) {
        const Rendered other = render(desc, 64);
        const double error = std::hypot(other.standardError, original.standardError);
        add(name, other.mean / original.mean - 1, "within 4 standard errors of 0",
            other.nonfinite == 0 && std::abs(other.mean - original.mean) <= 4 * error + 1e-5 * original.mean);
    }

    // Rays that leave a surface must not meet it again, however large it is and however far away.
    void radii() {
        for (const double radius : {1e-4, 1.0, 1e3, 1e4, 1e7}) {
            SphereDesc ball;
            ball.radius = radius, ball.material = "body";
            const Rendered rendered = render(convexBody({ball}, {0, 0, 1.5 * radius}, dvec3(0), 20), 256);
            addMean("sphere of radius " + formatted("%.0e", radius) + ", self-shadowing", rendered, 0.5);
        }
        // One of radius 1 on one of radius 1e7: the small one sees half a sky, less what it hides of the ground.
        SphereDesc ground, ball;
        ground.center = {0, -1e7, 0}, ground.radius = 1e7, ground.material = "body";
        ball.center = {0, 1, 0}, ball.material = "balanced";
        SceneDesc desc = convexBody({ground}, {0, 1.2, 4}, {0, 0.8, 0}, 40);
        // What emits as much as it does not reflect has radiance 1 like the sky, so all of the picture has.
        MaterialDesc& body = desc.materials["body"];
        body.emission = dvec3(0.5), body.sides = Sides::Both;
        desc.materials["balanced"] = body;
        desc.objects.push_back({ball});
        // Single precision knows the ground's surface to a unit only, as large as the ball: light sampling loses a
        // thousandth (measured: 0.0007 on processors, 0.0013 on an NVIDIA H200; scattering alone loses less than
        // 0.00002).
        addMean("radius ratio 1e7", render(desc, 256), 1, 2e-3);
    }

    // 0.1 has no finite binary fraction: sums of it go wrong first.
    void accumulation() {
        SceneDesc desc = seenFrom({0, 0, 2}, dvec3(0), 20);
        addMaterial(desc, "light", MaterialKind::Emitter, 0, 0.1);
        desc.objects.push_back({QuadDesc{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, "light"}});
        const std::uint32_t spp = options_.thorough ? 1'000'000 : 100'000;
        app::RenderSettings settings;
        settings.sampler = app::SamplerKind::Independent;
        const Rendered r = render(desc, spp, settings, 4);
        const double off = r.mean / static_cast<double>(0.1f) - 1;
        add(std::to_string(spp) + " samples per pixel", off, "|value| <= 1e-6", std::abs(off) <= 1e-6);
    }

    struct LitFloor {
        std::string name;
        SceneDesc desc;
        double irradiance = 0;
    };

    // Every way of sampling a light's shape, for lights that are seen or shine at grazing angles. The lights of one
    // call have one shape: a device compiles its shaders once for each way.
    void forEachShape(const std::vector<LitFloor>& floors, double allowance) {
        constexpr std::pair<app::ShapeSampling, const char*> kShapes[] = {
            {app::ShapeSampling::Auto, "auto"},
            {app::ShapeSampling::SolidAngle, "solid angle"},
            {app::ShapeSampling::Projected, "projected"}};
        for (const auto& [shape, label] : kShapes) {
            app::RenderSettings settings;
            settings.maxDepth = 2;
            settings.sphereLight = settings.quadLight = settings.triangleLight = shape;
            for (const auto& [name, desc, irradiance] : floors)
                addMean(name + ", " + label, render(desc, 1024, settings), 2 * 0.7 / kPi * irradiance, allowance);
        }
    }

    void grazing() {
        std::vector<LitFloor> floors;
        for (const double height : {1e-2, 1e-4}) { // of the light's plane beside the point
            const dvec3 corner(-1, 0.01, -height), u(2, 0, 0), v(0, 1, 0);
            SceneDesc desc = litFloor();
            desc.objects.push_back({QuadDesc{corner, u, v, "light"}});
            const std::vector<dvec3> outline{corner, corner + u, corner + u + v, corner + v};
            floors.push_back({"light's plane at " + formatted("%.0e", height), desc, irradianceOf(outline)});
        }
        forEachShape(floors, 2e-3);
        SphereDesc low;
        low.center = {0, 0.02, -2}, low.radius = 0.02, low.material = "light";
        SceneDesc desc = litFloor();
        desc.objects.push_back({low});
        const double d2 = glm::dot(low.center, low.center);
        forEachShape({{"sphere that touches the floor", desc, kPi * 4e-4 / d2 * 0.02 / std::sqrt(d2)}}, 1e-3);
    }

    void slivers() {
        std::vector<LitFloor> floors;
        for (const double thickness : {1e-2, 1e-4}) {
            MeshData mesh;
            mesh.positions = {{-1, 1, 0.3}, {1, 1, 0.3}, {0.1, 1, 0.3 - thickness}};
            mesh.triangles = {{0, 1, 2}};
            SceneDesc desc = litFloor();
            desc.objects.push_back({MeshDesc{mesh, "light"}});
            floors.push_back({"sliver of 1 : " + formatted("%.0e", thickness / 2), desc, irradianceOf(mesh.positions)});
        }
        forEachShape(floors, 1e-3);
    }

    // The floor twice: which of the two is hit must not matter.
    void coincident() {
        SceneDesc desc = litFloor();
        desc.objects.push_back(desc.objects.front());
        const dvec3 corner(-0.5, 1, -0.5), u(1, 0, 0), v(0, 0, 1);
        desc.objects.push_back({QuadDesc{corner, u, v, "light"}});
        app::RenderSettings settings;
        settings.maxDepth = 2;
        addMean("coincident floors", render(desc, 1024, settings),
                2 * 0.7 / kPi * irradianceOf({corner, corner + u, corner + u + v, corner + v}), 1e-4);
    }

    // Glass loses nothing: in a sky of 1 everything is 1, but for paths that are cut off.
    void nestedGlass() {
        SceneDesc desc = seenFrom({0, 0.3, 4}, dvec3(0), 30);
        desc.background = ConstantBackground{dvec3(1)};
        addMaterial(desc, "glass", MaterialKind::Dielectric, 1);
        for (const double radius : {1.0, 0.9, 0.5, 0.499}) {
            SphereDesc ball;
            ball.radius = radius, ball.material = "glass";
            desc.objects.push_back({ball});
        }
        app::RenderSettings settings;
        settings.maxDepth = 256;
        addMean("glass in glass", render(desc, 256, settings), 1, 1e-3);
    }

    void media() {
        for (const double depth : {1e-6, 1e-3, 1.0, 20.0}) {
            SceneDesc desc = seenFrom({0, 0, 4}, dvec3(0), 20);
            desc.background = ConstantBackground{dvec3(1)};
            desc.objects.push_back({MediumDesc{SphereBoundary{dvec3(0), 1.0}, 0.5 * depth, dvec3(1)}});
            app::RenderSettings settings;
            settings.maxDepth = 4096;
            addMean("white medium of depth " + formatted("%.0e", depth), render(desc, 256, settings), 1, 1e-4);
            desc = seenFrom({0, 0, 4}, dvec3(0), 1e-3);
            desc.background = ConstantBackground{dvec3(1)};
            desc.objects.push_back({MediumDesc{BoxBoundary{dvec3(-3, -3, -1), dvec3(3, 3, 1)}, 0.5 * depth, dvec3(0)}});
            if (depth > 1e-5 && depth < 10)
                addMean("black medium of depth " + formatted("%.0e", depth), render(desc, 4096), std::exp(-depth),
                        1e-6);
        }
    }

    // Built-in scenes of radiance 1, and those that are hard on weights: no sample may be other than a number.
    void furnaces() {
        const auto compiled = [](const char* id) {
            CompileOptions options;
            options.generatedAssets = true;
            return compileScene(findBuiltinScene(id), options);
        };
        addMean("furnace-mixed", render(compiled("furnace-mixed"), 128), 1, 1e-3);
        for (const char* id :
             {"cornell-box-lights", "veach-mis", "triangle-lights", "many-lights:100", "next-week-final"}) {
            double nonfinite = 0;
            for (const auto sampling : {app::LightSampling::Mis, app::LightSampling::MisBalance,
                                        app::LightSampling::Mixture, app::LightSampling::Bsdf}) {
                app::RenderSettings settings;
                settings.lightSampling = sampling;
                nonfinite += static_cast<double>(render(compiled(id), 64, settings).nonfinite);
            }
            add(std::string(id) + ": samples that are not finite", nonfinite, "= 0", nonfinite == 0);
        }
    }

    app::Engine& engine_;
    const StabilityOptions options_;
    std::vector<StabilityRow> rows_;
};

} // namespace

std::vector<StabilityRow> measureStability(app::Engine& engine, const StabilityOptions& options) {
    return StabilitySuite(engine, options).run();
}

Document describeStability(const std::vector<StabilityRow>& rows) {
    Table table{{"stress", "engine", "value", "criterion", "pass"}, {}};
    for (const StabilityRow& row : rows)
        table.rows.push_back(
            {row.name, row.engine, formatted("%.3g", row.value), row.criterion, row.pass ? "yes" : "NO"});
    const auto failed = std::count_if(rows.begin(), rows.end(), [](const StabilityRow& row) { return !row.pass; });
    return {Heading{1, "Numerical stability"}, table,
            Paragraph{std::to_string(rows.size()) + " rows, " + std::to_string(failed) + " failed"}};
}

} // namespace rt::bench
