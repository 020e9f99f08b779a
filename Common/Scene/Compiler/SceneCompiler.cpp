#include "Common/Scene/Compiler/SceneCompiler.h"

#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include <glm/trigonometric.hpp>

#include "Common/Scene/Compiler/CompileMemory.h"
#include "Common/Scene/Compiler/FeatureMask.h"
#include "Common/Scene/Compiler/InstancePlan.h"
#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Scene/Compiler/MaterialTable.h"
#include "Common/Scene/Compiler/ModelCache.h"
#include "Common/Scene/Compiler/PrimitiveSink.h"
#include "Common/Scene/Compiler/SceneHash.h"
#include "Common/Scene/Compiler/SkyMaps.h"
#include "Common/Scene/Compiler/SpecularCasters.h"
#include "Common/Scene/Compiler/SunSkyMap.h"
#include "Common/Scene/Compiler/TextureTable.h"
#include "Common/Scene/Compiler/TexturesInUse.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/SpherePower.h"

namespace rt::scene {

namespace {

void setRows(const Affine& map, shared::vec4 (&rows)[3]) {
    for (int row = 0; row < 3; ++row)
        rows[row] = shared::vec4(map.linear[0][row], map.linear[1][row], map.linear[2][row], map.offset[row]);
}

class Compiler {
  public:
    // `consumed`: desc, if nobody needs its meshes any more, or null.
    Compiler(const SceneDesc& desc, SceneDesc* consumed, const CompileOptions& options)
        : desc_(desc),
          consumed_(consumed),
          camera_(options.camera.value_or(desc.camera)),
          textures_(desc, options, *out_),
          materials_(desc, options, *out_, textures_),
          models_(desc, options, *out_, textures_, materials_),
          memory_(options.memory),
          sink_(*out_, materials_, memory_) {}

    std::shared_ptr<const CompiledScene> run() {
        out_->id = desc_.id;
        out_->title = desc_.title;
        out_->camera = camera_;
        out_->cameras = desc_.cameras;
        out_->motion = desc_.motion;
        for (const auto& [name, model] : desc_.models) out_->modelFiles.push_back(model.file);
        out_->defaults = desc_.render;
        out_->origin = desc_.camera.lookFrom;
        out_->globals.origin = shared::vec3(out_->origin);
        const Affine toWorld = translation(-out_->origin);
        const InstancePlan plan(desc_, materials_, models_, toWorld);
        textures_.loadImages(texturesInUse(desc_, plan, materials_, models_));
        sink_.expect(total(plan));
        emitWorld(plan, toWorld);
        emitSharedGeometries(plan);
        emitEllipsoids();
        placeDirectionalLights(bounds_, *out_);
        emitSky();
        finishLights(*out_);
        findSpecularCasters(*out_);
        for (const TargetDesc& target : desc_.importanceTargets) addTarget(target, toWorld);
        finish();
        if (!bounds_.empty()) {
            out_->lower = bounds_.lower + out_->origin;
            out_->upper = bounds_.upper + out_->origin;
        }
        if (memory_ != nullptr) {
            memory_->surfaces = sink_.takeSurfaces();
            memory_->scene = out_;
        }
        return out_;
    }

  private:
    // ---- objects ----------------------------------------------------------------------------------------------------

    // Of objects that are not const, meshes that nobody shares are given back as they are compiled.
    template <class Objects>
    void emit(Objects& objects, const Placement& parent) {
        Placement at = parent;
        for (std::size_t i = 0; i < objects.size(); ++i) {
            if (objects[i].hidden) {
                if (emitsOwnObjects_) nextObject_ += leafCount(objects[i]);
                continue;
            }
            at.place.assign(parent.place).append("/").append(std::to_string(i));
            std::visit([&](auto& object) { emitOne(object, at); }, objects[i].shape);
            const bool isGroup = std::holds_alternative<GroupDesc>(objects[i].shape);
            if (emitsOwnObjects_ && !isGroup) noteOrigin(nextObject_++);
        }
    }

    // Where the primitives of the world that have come since the last call are from.
    void noteOrigin(std::uint32_t object) {
        Origins& origins = out_->origins;
        const auto note = [object](std::vector<OriginRun>& runs, std::size_t& noted, std::size_t size) {
            if (size > noted) runs.push_back({static_cast<std::uint32_t>(noted), object});
            noted = size;
        };
        note(origins.spheres, noted_.spheres, out_->spheres.size());
        note(origins.quads, noted_.quads, out_->quads.size());
        note(origins.triangles, noted_.triangles, out_->triangles.size());
        note(origins.rounds, noted_.rounds, out_->rounds.size());
        note(ellipsoidOrigins_, notedEllipsoids_, sink_.ellipsoids().size());
    }

    template <typename Shape>
    void emitOne(Shape& shape, const Placement& at) {
        using Desc = std::remove_const_t<Shape>;
        if constexpr (std::is_same_v<Desc, GroupDesc>)
            emitGroup(shape, at);
        else if constexpr (std::is_same_v<Desc, MeshDesc>)
            emitMesh(shape, at);
        else if constexpr (std::is_same_v<Desc, MediumDesc>)
            emitMedium(shape, at);
        else if constexpr (!std::is_same_v<Desc, InstanceDesc>) // the plan has those
            sink_.add(shape, at);
    }
    template <typename Group>
    void emitGroup(Group& group, Placement at) {
        at.local = at.local * toAffine(group.transform);
        at.place += "/objects";
        emit(group.objects, at);
    }
    void emitMesh(const MeshDesc& object, const Placement& at) {
        for (const ModelCache::Part& part : models_.parts(object)) {
            const bool isLight = object.light && !part.isUnlit;
            std::visit([&](const auto* mesh) { sink_.add(*mesh, *part.material, isLight, at); }, part.mesh);
        }
    }
    void emitMesh(MeshDesc& object, const Placement& at) {
        const auto consume = [&](auto* data) {
            auto* own = data == nullptr ? nullptr : data->own();
            if (own != nullptr) sink_.add(*own, materials_.find(object.material), object.light, at);
            return own != nullptr;
        };
        if (consume(std::get_if<Boxed<MeshData>>(&object.source))) return;
        if (consume(std::get_if<Boxed<FloatMeshData>>(&object.source))) return;
        emitMesh(std::as_const(object), at);
    }

    void emitMedium(const MediumDesc& desc, const Placement& at) {
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

    // ---- totals -----------------------------------------------------------------------------------------------------

    template <class Real>
    static void countMesh(const MeshOf<Real>& mesh, std::size_t times, PrimitiveCounts& sum) {
        sum.triangles += times * mesh.triangles.size();
        sum.positions += times * mesh.positions.size();
        sum.normals += times * mesh.normals.size();
        sum.uvs += times * (mesh.uvs.size() + mesh.uvs2.size());
        sum.colors += times * mesh.colors.size();
        sum.tangents += times * mesh.tangents.size();
    }
    // Of objects that are added so many times.
    void count(const std::vector<ObjectDesc>& objects, std::size_t times, PrimitiveCounts& sum) {
        for (const ObjectDesc& object : objects) {
            const auto& shape = object.shape;
            if (object.hidden) continue;
            if (std::holds_alternative<SphereDesc>(shape))
                sum.spheres += times;
            else if (const auto* spheres = std::get_if<SphereSetDesc>(&shape))
                sum.spheres += times * spheres->centers.size();
            else if (std::holds_alternative<QuadDesc>(shape))
                sum.quads += times;
            else if (std::holds_alternative<BoxDesc>(shape))
                sum.quads += 6 * times;
            else if (std::holds_alternative<DiskDesc>(shape) || std::holds_alternative<CylinderDesc>(shape))
                sum.rounds += times;
            else if (const auto* group = std::get_if<GroupDesc>(&shape))
                count(group->objects, times, sum);
            else if (const auto* mesh = std::get_if<MeshDesc>(&shape))
                for (const ModelCache::Part& part : models_.parts(*mesh))
                    std::visit([&](const auto* data) { countMesh(*data, times, sum); }, part.mesh);
        }
    }

    PrimitiveCounts total(const InstancePlan& plan) {
        PrimitiveCounts sum;
        count(desc_.objects, 1, sum);
        for (const auto& [name, prototype] : plan.prototypes()) {
            std::size_t times = prototype.isShared ? 1 : 0;
            for (const Occurrence& occurrence : prototype.occurrences)
                times += !prototype.isShared || occurrence.isBaked() ? 1 : 0;
            count(*prototype.objects, times, sum);
        }
        return sum;
    }

    // ---- geometries and instances ----------------------------------------------------------------------------------

    void emitWorld(const InstancePlan& plan, const Affine& toWorld) {
        emitsOwnObjects_ = true;
        const Placement world{toWorld, {}, Part::All, nullptr, "/objects"};
        if (consumed_ != nullptr)
            emit(consumed_->objects, world);
        else
            emit(desc_.objects, world);
        emitsOwnObjects_ = false;
        for (const auto& [name, prototype] : plan.prototypes())
            for (const Occurrence& occurrence : prototype.occurrences) {
                const Part part = prototype.isShared && !occurrence.isBaked() ? Part::Rest : Part::All;
                emit(*prototype.objects, {occurrence.toWorld, {}, part, occurrence.material, "/prototypes/" + name});
                noteOrigin(occurrence.object);
            }
        bounds_.add(sink_.finishGeometry(), {});
    }

    void emitSharedGeometries(const InstancePlan& plan) {
        for (const auto& [name, prototype] : plan.prototypes()) {
            if (!prototype.isShared) continue;
            emit(*prototype.objects, {{}, {}, Part::Shared, nullptr, "/prototypes/" + name});
            const Bounds bounds = sink_.finishGeometry();
            if (bounds.empty()) {
                out_->geometries.pop_back();
                continue;
            }
            for (const Occurrence& occurrence : prototype.occurrences)
                if (!occurrence.isBaked())
                    addInstance(occurrence.toWorld, bounds,
                                occurrence.material ? materials_.index(*occurrence.material) : shared::kNone,
                                shared::kNone, occurrence.object);
        }
    }

    void emitEllipsoids() {
        if (sink_.ellipsoids().empty()) return;
        shared::Sphere sphere{};
        sphere.radius = 1;
        sphere.power = shared::kInfinity;
        sphere.material = sink_.ellipsoids().front().material;
        sphere.light = shared::kNone;
        out_->spheres.push_back(sphere);
        if (!out_->sphereMotions.empty()) out_->sphereMotions.emplace_back(0.0f);
        sink_.finishGeometry();
        Bounds cube;
        cube.add(glm::dvec3(0), 1);
        for (std::uint32_t i = 0; i < sink_.ellipsoids().size(); ++i) {
            const Ellipsoid& ellipsoid = sink_.ellipsoids()[i];
            addInstance(ellipsoid.toWorld, cube, ellipsoid.material, ellipsoid.light, originOf(ellipsoidOrigins_, i));
        }
    }

    // Of the latest geometry.
    void addInstance(const Affine& toWorld, const Bounds& bounds, std::uint32_t material, std::uint32_t light,
                     std::uint32_t object) {
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
        instance.light = light;
        out_->instances.push_back(instance);
        out_->origins.instances.push_back(object);
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
        } else if (const auto* image = std::get_if<ImageBackground>(&desc_.background)) {
            ImageTexture source;
            source.file = image->file;
            globals.skyImage = textures_.image(source);
            if (mustBeMapped(*image)) globals.skyImage = appendSkyMap(*image, globals.skyImage, *out_);
            emitSkyImage(image->factor, image->rotation);
        } else {
            const auto& sky = std::get<SunSkyBackground>(desc_.background);
            globals.skyImage = appendSunSkyMap(sky, *out_);
            emitSkyImage(sky.factor, sunSkyRotation(sky));
        }
    }
    void emitSkyImage(const glm::dvec3& factor, double rotation) {
        shared::SceneGlobals& globals = out_->globals;
        globals.skyTop = shared::vec3(factor);
        const double turn = glm::radians(rotation);
        globals.skyTurn = shared::vec2(std::cos(turn), std::sin(turn));
        globals.skyKind = appendSkyLight(bounds_, *out_) ? shared::kSkyImage : shared::kSkyBlack;
    }

    void addTarget(const TargetDesc& target, const Affine& toWorld) {
        if (const auto* boundary = std::get_if<SphereBoundary>(&target.shape)) {
            shared::Sphere sphere{};
            sphere.center = shared::vec3(toWorld.point(boundary->center));
            sphere.radius = static_cast<float>(boundary->radius);
            sphere.power = spherePower(toWorld.point(boundary->center), boundary->radius);
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

    // Some arrays were made without knowing their length. What nobody has touched of others takes no memory.
    template <typename T>
    static void shrink(std::vector<T>& values) {
        if (values.capacity() - values.size() > values.size() / 8) values.shrink_to_fit();
    }
    void finish() {
#define RT_SHRINK(type, name, ...) shrink(out_->name);
        RT_SCENE_ARRAYS(RT_SHRINK, RT_SHRINK)
#undef RT_SHRINK
        shared::SceneGlobals& globals = out_->globals;
        globals.mediumCount = static_cast<std::uint32_t>(out_->media.size());
        globals.instanceCount = static_cast<std::uint32_t>(out_->instances.size());
        globals.sceneRadius = static_cast<float>(bounds_.radius());
        out_->features = featureMask(*out_);
        out_->hash = sceneHash(*out_);
        out_->notices.insert(out_->notices.end(), desc_.notices.begin(), desc_.notices.end());
        sink_.appendNotices(out_->notices);
        if (droppedMedia_ > 0)
            out_->notices.push_back(counted(droppedMedia_, "medium without volume or density was dropped",
                                            "media without volume or density were dropped"));
        if (droppedInstances_ > 0)
            out_->notices.push_back(counted(droppedInstances_, "instance without volume was dropped",
                                            "instances without volume were dropped"));
    }

    const SceneDesc& desc_;
    SceneDesc* const consumed_;
    const CameraDesc camera_;
    std::shared_ptr<CompiledScene> out_ = std::make_shared<CompiledScene>();
    TextureTable textures_;
    MaterialTable materials_;
    ModelCache models_;
    CompileMemory* const memory_; // or null
    PrimitiveSink sink_;
    Bounds bounds_; // of everything, in world space
    std::uint64_t droppedMedia_ = 0;
    std::uint64_t droppedInstances_ = 0;
    bool emitsOwnObjects_ = false; // those of the scene's own lists
    std::uint32_t nextObject_ = 0; // of them
    PrimitiveCounts noted_;        // whose origin is
    std::vector<OriginRun> ellipsoidOrigins_;
    std::size_t notedEllipsoids_ = 0;
};

} // namespace

std::shared_ptr<const CompiledScene> compileScene(const SceneDesc& desc, const CompileOptions& options) {
    return Compiler(desc, nullptr, options).run();
}

std::shared_ptr<const CompiledScene> compileScene(SceneDesc&& desc, const CompileOptions& options) {
    // What is compiled next would take over surfaces of meshes that are no more.
    return Compiler(desc, options.memory == nullptr ? &desc : nullptr, options).run();
}

} // namespace rt::scene
