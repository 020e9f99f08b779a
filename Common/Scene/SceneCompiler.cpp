#include "Common/Scene/SceneCompiler.h"

#include <algorithm>
#include <map>
#include <string>

#include "Common/Core/Error.h"
#include "Common/Scene/FeatureMask.h"
#include "Common/Scene/LightTable.h"
#include "Common/Scene/MaterialTable.h"
#include "Common/Scene/PrimitiveSink.h"
#include "Common/Scene/SceneHash.h"
#include "Common/Scene/TextureTable.h"

namespace rt::scene {

namespace {

constexpr std::size_t kSharedPrimitives = 64;  // below it an instance costs more than copies of the primitives
constexpr std::size_t kMaxInstances = 1u << 24;
constexpr double kMaxPrimitives = 1u << 28;

// One appearance of a prototype.
struct Occurrence {
    Affine toWorld;
    const MaterialDesc* material;  // replaces those of the surfaces unless null
};

void setRows(const Affine& map, shared::vec4 (&rows)[3]) {
    for (int row = 0; row < 3; ++row)
        rows[row] = shared::vec4(map.linear[0][row], map.linear[1][row], map.linear[2][row], map.offset[row]);
}

class Compiler {
  public:
    Compiler(const SceneDesc& desc, const CompileOptions& options)
        : desc_(desc),
          textures_(desc, options, *out_),
          materials_(desc, options, *out_, textures_),
          sink_(*out_, materials_) {}

    std::shared_ptr<const CompiledScene> run() {
        out_->id = desc_.id;
        out_->title = desc_.title;
        out_->camera = desc_.camera;
        out_->defaults = desc_.render;
        out_->origin = desc_.camera.lookFrom;
        out_->globals.origin = shared::vec3(out_->origin);
        const Affine toWorld = translation(-out_->origin);
        findOccurrences(desc_.objects, toWorld, nullptr, "/objects");
        checkSize();
        emitWorld(toWorld);
        emitGeometries();
        emitSky();
        finishLights(*out_);
        for (const TargetDesc& target : desc_.importanceTargets)
            addTarget(target, toWorld);
        finish();
        return out_;
    }

  private:
    // ---- which prototypes appear where ------------------------------------------------------------------------------

    void findOccurrences(const std::vector<ObjectDesc>& objects, const Affine& toWorld, const MaterialDesc* material,
                         const std::string& place) {
        for (std::size_t i = 0; i < objects.size(); ++i) {
            if (const auto* group = std::get_if<GroupDesc>(&objects[i].shape))
                findOccurrences(group->objects, toWorld * toAffine(group->transform), material,
                                place + "/" + std::to_string(i) + "/objects");
            else if (const auto* instance = std::get_if<InstanceDesc>(&objects[i].shape))
                enter(*instance, toWorld, material, place + "/" + std::to_string(i));
        }
    }

    void enter(const InstanceDesc& instance, const Affine& toWorld, const MaterialDesc* material,
               const std::string& place) {
        const auto prototype = desc_.prototypes.find(instance.prototype);
        if (prototype == desc_.prototypes.end())
            throw InputError(desc_.id + ": " + place + ": prototype \"" + instance.prototype + "\" is not defined");
        if (std::find(open_.begin(), open_.end(), &prototype->first) != open_.end())
            throw InputError(desc_.id + ": " + place + ": prototype \"" + instance.prototype + "\" contains itself");
        if (++occurrenceCount_ > kMaxInstances)
            throw InputError(desc_.id + ": " + place + ": more than 2^24 instances");
        if (!material && !instance.material.empty()) material = &materials_.find(instance.material);
        const Affine placed = toWorld * toAffine(instance.transform);
        occurrences_[prototype->first].push_back({placed, material});
        open_.push_back(&prototype->first);
        findOccurrences(prototype->second, placed, material, "/prototypes/" + prototype->first);
        open_.pop_back();
    }

    static std::size_t primitiveCount(const std::vector<ObjectDesc>& objects) {
        struct Count {
            std::size_t operator()(const SphereSetDesc& spheres) const { return spheres.centers.size(); }
            std::size_t operator()(const BoxDesc&) const { return 6; }
            std::size_t operator()(const MeshDesc& mesh) const {
                return std::get<MeshData>(mesh.source).triangles.size();
            }
            std::size_t operator()(const MediumDesc&) const { return 0; }
            std::size_t operator()(const GroupDesc& group) const { return primitiveCount(group.objects); }
            std::size_t operator()(const InstanceDesc&) const { return 0; }
            std::size_t operator()(const SphereDesc&) const { return 1; }
            std::size_t operator()(const QuadDesc&) const { return 1; }
        };
        std::size_t sum = 0;
        for (const ObjectDesc& object : objects)
            sum += std::visit(Count{}, object.shape);
        return sum;
    }

    bool isShared(const std::string& prototype) const {
        return occurrences_.at(prototype).size() > 1 &&
               primitiveCount(desc_.prototypes.at(prototype)) >= kSharedPrimitives;
    }

    static bool isBaked(const Occurrence& occurrence) { return occurrence.material && emits(*occurrence.material); }

    void checkSize() const {
        double primitives = static_cast<double>(primitiveCount(desc_.objects));
        for (const auto& [name, occurrences] : occurrences_)
            primitives += static_cast<double>(primitiveCount(desc_.prototypes.at(name))) *
                          static_cast<double>(isShared(name) ? 1 : occurrences.size());
        if (primitives > kMaxPrimitives) throw InputError(desc_.id + ": the scene comes to more than 2^28 primitives");
    }

    // ---- filling the arrays -----------------------------------------------------------------------------------------

    void emit(const std::vector<ObjectDesc>& objects, Placement at) {
        const Affine local = at.local;
        const std::string place = at.place;
        for (std::size_t i = 0; i < objects.size(); ++i) {
            at.place = place + "/" + std::to_string(i);
            at.local = local;
            std::visit([&](const auto& object) { emitOne(object, at); }, objects[i].shape);
        }
    }

    template <typename Surface>
    void emitOne(const Surface& surface, const Placement& at) {
        sink_.add(surface, at);
    }
    void emitOne(const GroupDesc& group, Placement at) {
        at.local = at.local * toAffine(group.transform);
        at.place += "/objects";
        emit(group.objects, at);
    }
    void emitOne(const InstanceDesc&, const Placement&) {}
    void emitOne(const MeshDesc& mesh, const Placement& at) {
        if (const auto* data = std::get_if<MeshData>(&mesh.source))
            sink_.add(*data, materials_.find(mesh.material), mesh.light, at);
    }

    void emitOne(const MediumDesc& desc, const Placement& at) {
        if (at.part == Part::Shared) return;
        shared::Medium medium{};
        Affine boundary = at.outer * at.local;
        if (const auto* sphere = std::get_if<SphereBoundary>(&desc.boundary)) {
            medium.shape = shared::kMediumSphere;
            boundary = boundary * translation(sphere->center) * scaling(glm::dvec3(sphere->radius));
        } else {
            const auto& box = std::get<BoxBoundary>(desc.boundary);
            medium.shape = shared::kMediumBox;
            boundary = boundary * translation(0.5 * (box.min + box.max)) * scaling(0.5 * (box.max - box.min));
        }
        const std::optional<Affine> toLocal = inverse(boundary);
        if (!toLocal || !(desc.density > 0)) {
            ++droppedMedia_;
            return;
        }
        setRows(*toLocal, medium.toLocal);
        medium.extinction = static_cast<float>(desc.density);
        medium.texture = textures_.resolve(desc.albedo, medium.albedo);
        out_->media.push_back(medium);
        Bounds cube;
        cube.add(glm::dvec3(0), 1);
        bounds_.add(cube, boundary);
    }

    void emitWorld(const Affine& toWorld) {
        emit(desc_.objects, {toWorld, {}, Part::All, nullptr, "/objects"});
        for (const auto& [name, occurrences] : occurrences_)
            for (const Occurrence& occurrence : occurrences) {
                const Part part = isShared(name) && !isBaked(occurrence) ? Part::Rest : Part::All;
                emit(desc_.prototypes.at(name),
                     {occurrence.toWorld, {}, part, occurrence.material, "/prototypes/" + name});
            }
        bounds_.add(sink_.finishGeometry(), {});
    }

    void emitGeometries() {
        for (const auto& [name, occurrences] : occurrences_) {
            if (!isShared(name)) continue;
            emit(desc_.prototypes.at(name), {{}, {}, Part::Shared, nullptr, "/prototypes/" + name});
            const Bounds bounds = sink_.finishGeometry();
            if (bounds.empty()) {
                out_->geometries.pop_back();
                continue;
            }
            for (const Occurrence& occurrence : occurrences)
                if (!isBaked(occurrence))
                    addInstance(occurrence.toWorld, bounds,
                                occurrence.material ? materials_.index(*occurrence.material) : shared::kNone);
        }
        emitEllipsoids();
    }

    void emitEllipsoids() {
        if (sink_.ellipsoids().empty()) return;
        shared::Sphere sphere{};
        sphere.radius = 1;
        sphere.material = sink_.ellipsoids().front().material;
        sphere.light = shared::kNone;
        out_->spheres.push_back(sphere);
        if (!out_->sphereMotions.empty()) out_->sphereMotions.emplace_back(0.0f);
        sink_.finishGeometry();
        Bounds cube;
        cube.add(glm::dvec3(0), 1);
        for (const Ellipsoid& ellipsoid : sink_.ellipsoids())
            addInstance(ellipsoid.toWorld, cube, ellipsoid.material);
    }

    // Of the latest geometry.
    void addInstance(const Affine& toWorld, const Bounds& bounds, std::uint32_t material) {
        const std::optional<Affine> toObject = inverse(toWorld);
        if (!toObject) {
            ++droppedInstances_;
            return;
        }
        shared::Instance instance{};
        setRows(toWorld, instance.toWorld);
        setRows(*toObject, instance.toObject);
        instance.geometry = static_cast<std::uint32_t>(out_->geometries.size() - 1);
        instance.material = material;
        out_->instances.push_back(instance);
        bounds_.add(bounds, toWorld);
    }

    void emitSky() {
        shared::SceneGlobals& globals = out_->globals;
        globals.skyImage = globals.skyLight = shared::kNone;
        if (const auto* constant = std::get_if<ConstantBackground>(&desc_.background)) {
            globals.skyKind = constant->color == glm::dvec3(0) ? shared::kSkyBlack : shared::kSkyConstant;
            globals.skyTop = globals.skyBottom = shared::vec3(constant->color);
        } else if (const auto* gradient = std::get_if<GradientBackground>(&desc_.background)) {
            globals.skyKind = shared::kSkyGradient;
            globals.skyTop = shared::vec3(gradient->top);
            globals.skyBottom = shared::vec3(gradient->bottom);
        } else {
            const auto& sky = std::get<ImageBackground>(desc_.background);
            globals.skyImage = textures_.image(sky.file, {});
            globals.skyTop = shared::vec3(sky.factor);
            globals.skyKind = appendSkyLight(bounds_, *out_) ? shared::kSkyImage : shared::kSkyBlack;
        }
    }

    void addTarget(const TargetDesc& target, const Affine& toWorld) {
        if (const auto* boundary = std::get_if<SphereBoundary>(&target.shape)) {
            shared::Sphere sphere{};
            sphere.center = shared::vec3(toWorld.point(boundary->center));
            sphere.radius = static_cast<float>(boundary->radius);
            appendTarget(sphereLight(sphere, shared::vec3(0)), *out_);
        } else {
            const auto& desc = std::get<QuadDesc>(target.shape);
            shared::Quad quad{};
            quad.corner = shared::vec3(toWorld.point(desc.corner));
            quad.edgeU = shared::vec3(desc.edgeU);
            quad.edgeV = shared::vec3(desc.edgeV);
            quad.normal = shared::vec3(glm::normalize(glm::cross(desc.edgeU, desc.edgeV)));
            appendTarget(quadLight(quad), *out_);
        }
    }

    void finish() {
        shared::SceneGlobals& globals = out_->globals;
        globals.mediumCount = static_cast<std::uint32_t>(out_->media.size());
        globals.instanceCount = static_cast<std::uint32_t>(out_->instances.size());
        globals.sceneRadius = static_cast<float>(bounds_.radius());
        out_->features = featureMask(*out_);
        out_->hash = sceneHash(*out_);
        sink_.appendNotices(out_->notices);
        if (droppedMedia_ > 0)
            out_->notices.push_back(std::to_string(droppedMedia_) + " media without volume or density were dropped");
        if (droppedInstances_ > 0)
            out_->notices.push_back(std::to_string(droppedInstances_) + " instances without volume were dropped");
    }

    const SceneDesc& desc_;
    std::shared_ptr<CompiledScene> out_ = std::make_shared<CompiledScene>();
    TextureTable textures_;
    MaterialTable materials_;
    PrimitiveSink sink_;
    std::map<std::string, std::vector<Occurrence>> occurrences_;  // by prototype
    std::vector<const std::string*> open_;                        // prototypes being entered
    std::size_t occurrenceCount_ = 0;
    Bounds bounds_;  // of everything, in world space
    std::uint64_t droppedMedia_ = 0;
    std::uint64_t droppedInstances_ = 0;
};

}  // namespace

std::shared_ptr<const CompiledScene> compileScene(const SceneDesc& desc, const CompileOptions& options) {
    return Compiler(desc, options).run();
}

}  // namespace rt::scene
