#include "Common/Scene/Pbrt/PbrtLoader.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "Common/Core/Printable.h"
#include "Common/Scene/Affine.h"
#include "Common/Scene/Obj/ObjText.h"
#include "Common/Scene/Pbrt/PbrtCamera.h"
#include "Common/Scene/Pbrt/PbrtColor.h"
#include "Common/Scene/Pbrt/PbrtLights.h"
#include "Common/Scene/Pbrt/PbrtMaps.h"
#include "Common/Scene/Pbrt/PbrtMedia.h"
#include "Common/Scene/Pbrt/PbrtParser.h"
#include "Common/Scene/Pbrt/PbrtState.h"
#include "Common/Scene/Placing.h"
#include "Common/Scene/Tangents.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;
using K = PbrtKeyword;

class PbrtLoader {
  public:
    explicit PbrtLoader(const fs::path& path) : path_(fs::absolute(path).lexically_normal()), files_(path) {
        scene_.id = path.filename().string();
        scene_.title = printable(scene_.id);
        PbrtParameters usual;
        usual.place = {std::make_shared<const std::string>(path.string()), 1};
        materials_.add("diffuse", std::move(usual)); // kUsual
        scene_.background = ConstantBackground{};
    }

    SceneDesc run() {
        const auto handle = [this](PbrtDirective& directive) { take(directive); };
        parser_.read(path_, handle);
        if (!inWorld_) throw InputError(path_.string() + ": there is no WorldBegin in it");
        if (!saved_.empty()) saved_.back().place.fail("there is no end of this " + saved_.back().name);
        if (object_) object_->place.fail("there is no ObjectEnd of this ObjectBegin");
        setPbrtCamera(view_, mirror_, scene_, notices_);
        if (view_.mirrors() && inWorld_) swapCheckers();
        notices_.appendTo(scene_.notices);
        if (!files_.foundInOtherCase().empty())
            scene_.notices.push_back("files that are named in other case: " + listed(files_.foundInOtherCase()));
        return std::move(scene_);
    }

  private:
    struct Saved {
        PbrtState state;
        std::string name; // of the directive
        PbrtPlace place;
        bool isImport = false;
    };
    struct Object {
        std::string name;
        PbrtPlace place;
        std::vector<ObjectDesc> objects;
    };

    // ---- directives -------------------------------------------------------------------------------------------------

    void take(PbrtDirective& d) {
        switch (d.keyword) {
            case K::Translate:
            case K::Scale:
            case K::Rotate:
            case K::LookAt:
            case K::ConcatTransform:
                return state_.concat(map(d));
            case K::Transform: {
                const Affine both = map(d);
                return state_.set({both, both});
            }
            case K::Identity:
                return state_.set({});
            case K::CoordinateSystem:
                systems_[d.texts[0]] = state_.transforms;
                return;
            case K::CoordSysTransform:
                return useSystem(d);
            case K::ActiveTransform:
                return activate(d);
            case K::TransformTimes:
                return;
            case K::AttributeBegin:
            case K::TransformBegin:
            case K::Import:
                saved_.push_back({state_, std::string(d.name), d.place, d.keyword == K::Import});
                return;
            case K::AttributeEnd:
            case K::TransformEnd:
                return restore(d);
            case K::ReverseOrientation:
                state_.isReversed = !state_.isReversed;
                return;
            case K::ColorSpace:
                return setColorSpace(d);
            case K::Attribute:
                return addDefaults(d);
            case K::MediumInterface:
                state_.inside = d.texts[0];
                return;
            default:
                return inWorld_ ? takeInWorld(d) : takeBeforeWorld(d);
        }
    }

    void takeBeforeWorld(PbrtDirective& d) {
        switch (d.keyword) {
            case K::Camera:
                view_.kind = d.texts[0];
                view_.camera = std::move(d.parameters);
                view_.fromWorld = state_.transforms[0];
                if (const std::optional<Affine> toWorld = inverse(view_.fromWorld))
                    systems_["camera"] = {*toWorld, *toWorld};
                if (state_.moves()) notices_.add("the motion of the camera is left out", d.place);
                return;
            case K::Film:
                return view_.setFilm(std::move(d.parameters), notices_);
            case K::Integrator:
            case K::Sampler:
            case K::PixelFilter:
            case K::Accelerator:
                if (d.keyword != K::Accelerator) methods_.push_back(d.parameters.what);
                return;
            case K::Option:
                return; // of how pbrt renders
            case K::MakeNamedMedium:
                return media_.define(d.texts[0], std::move(d.parameters));
            case K::WorldBegin:
                return beginWorld(d);
            default:
                d.place.fail(std::string(d.name) + " must stand after WorldBegin");
        }
    }

    void beginWorld(const PbrtDirective& d) {
        inWorld_ = true;
        if (!state_.inside.empty()) notices_.add("the medium around the camera is left out", d.place);
        state_.inside.clear();
        state_.isActive = {true, true};
        state_.set({});
        systems_["world"] = {};
        if (view_.mirrors()) mirror_ = scaling({-1, 1, 1});
        std::string methods;
        for (const std::string& method : methods_) methods += (methods.empty() ? "" : ", ") + method;
        if (!methods.empty()) notices_.add("how pbrt would render it is left out: " + methods, d.place);
    }

    void takeInWorld(PbrtDirective& d) {
        switch (d.keyword) {
            case K::Shape:
                return addShape(d);
            case K::Material:
                state_.material = materials_.add(d.texts[0], withDefaults(d, "material"));
                return;
            case K::MakeNamedMaterial:
                return materials_.addNamed(d.texts[0], withDefaults(d, "material"));
            case K::NamedMaterial:
                state_.material = materials_.named(d.texts[0], d.place);
                return;
            case K::Texture:
                return addTexture(d);
            case K::LightSource:
                if (state_.moves()) notices_.add("motion is left out: all stands where it is at the start", d.place);
                return lights_.add(d.texts[0], withDefaults(d, "light"), mirror_ * checked(d));
            case K::AreaLightSource:
                if (d.texts[0] != "diffuse") d.parameters.fail("the area light is unknown; known is diffuse");
                state_.areaLight = std::make_shared<const PbrtParameters>(withDefaults(d, "light"));
                return;
            case K::ObjectBegin:
                return beginObject(d);
            case K::ObjectEnd:
                return endObject(d);
            case K::ObjectInstance:
                return addInstance(d);
            case K::MakeNamedMedium:
                return media_.define(d.texts[0], std::move(d.parameters));
            default:
                d.place.fail(std::string(d.name) + " must stand before WorldBegin");
        }
    }

    // ---- state ------------------------------------------------------------------------------------------------------

    Affine map(const PbrtDirective& d) {
        if (hasPerspective(d)) notices_.add("perspective in transforms is left out", d.place);
        return pbrtMap(d);
    }

    void restore(const PbrtDirective& d) {
        const bool endsImport = !d.place.file;
        if (endsImport && !saved_.empty() && !saved_.back().isImport)
            saved_.back().place.fail("there is no end of this " + saved_.back().name + " in its file");
        if (saved_.empty() || saved_.back().isImport != endsImport || saved_.back().name == "ObjectBegin")
            d.place.fail(std::string(d.name) + " has no begin");
        state_ = std::move(saved_.back().state);
        saved_.pop_back();
        parser_.setColorSpace(state_.space);
    }

    void useSystem(const PbrtDirective& d) {
        const auto found = systems_.find(d.texts[0]);
        if (found != systems_.end()) return state_.set(found->second);
        std::string known;
        for (const auto& [name, maps] : systems_) known += (known.empty() ? "" : ", ") + printable(name, 100);
        d.parameters.fail("is no coordinate system; known are " + (known.empty() ? "none" : known));
    }

    void activate(const PbrtDirective& d) {
        const std::string which = d.texts.empty() ? "" : d.texts[0];
        if (which != "StartTime" && which != "EndTime" && which != "All")
            d.place.fail("ActiveTransform \"" + printable(which, 100) + "\": must be StartTime, EndTime or All");
        state_.isActive = {which != "EndTime", which != "StartTime"};
    }

    void setColorSpace(const PbrtDirective& d) {
        const PbrtColorSpace* space = pbrtColorSpace(d.texts[0]);
        if (!space) d.parameters.fail("the colour space is unknown; known are " + std::string(kPbrtColorSpaces));
        state_.space = space;
        parser_.setColorSpace(space);
    }

    void addDefaults(PbrtDirective& d) {
        const std::string& of = d.texts[0];
        if (of != "shape" && of != "light" && of != "material" && of != "medium" && of != "texture")
            d.parameters.fail("must be of shape, light, material, medium or texture");
        auto& list = state_.defaults[of];
        for (PbrtParameter& parameter : d.parameters.list) list.insert(list.begin(), std::move(parameter));
    }

    // What a directive does not say itself.
    PbrtParameters withDefaults(PbrtDirective& d, const char* of) const {
        PbrtParameters parameters = std::move(d.parameters);
        const auto found = state_.defaults.find(of);
        if (found == state_.defaults.end()) return parameters;
        for (PbrtParameter parameter : found->second) {
            parameter.isUsed = true; // not all of them are for all
            parameters.list.push_back(std::move(parameter));
        }
        return parameters;
    }

    const Affine& checked(const PbrtDirective& d) const {
        const Affine& map = state_.transforms[0];
        if (!isWithinLimits(map)) d.place.fail(std::string(d.name) + ": the transform exceeds 1e9");
        return map;
    }

    // ---- objects ----------------------------------------------------------------------------------------------------

    void addTexture(PbrtDirective& d) {
        const std::string name = d.texts[0], type = d.texts[1], kind = d.texts[2];
        if (type != "spectrum" && type != "float" && type != "color")
            d.parameters.fail("of type \"" + printable(type, 100) + "\": must be spectrum or float");
        const PbrtParameters parameters = withDefaults(d, "texture");
        textures_.define(name, type != "float", kind, parameters, checked(d));
        notices_.addUnused(parameters);
    }

    void addShape(PbrtDirective& d) {
        const Affine map = checked(d);
        if (state_.moves()) notices_.add("motion is left out: all stands where it is at the start", d.place);
        const PbrtParameters parameters = withDefaults(d, "shape");
        if (!inverse(map)) return notices_.add("shapes are left out whose transform cannot be inverted", d.place);
        PbrtShape shape = shapes_.make(d.texts[0], parameters, state_.isReversed);
        PbrtSurface surface;
        surface.opacity =
            textures_.number(textures_.value(parameters, "alpha", PbrtUse::Number, glm::dvec3(1)), d.place);
        notices_.addUnused(parameters);
        if (shape.objects.empty()) return;
        if (materials_.isInterface(state_.material)) {
            media_.fill(state_.inside, shape, map, d.place);
            if (state_.areaLight) notices_.add("shapes without a material emit nothing", d.place);
            return addObjects(std::move(shape.objects), map);
        }
        if (!state_.inside.empty()) notices_.add("media within surfaces are left out", d.place);
        if (state_.areaLight && object_)
            notices_.add("shapes of objects with instances emit nothing", d.place);
        else if (state_.areaLight)
            lights_.addEmission(*state_.areaLight, shape, map, surface);
        const std::string material = materials_.use(state_.material, surface);
        const bool needsTangents = materials_.needsTangents(state_.material);
        for (ObjectDesc& object : shape.objects) dress(object, material, needsTangents);
        addObjects(std::move(shape.objects), map);
    }

    static void dress(ObjectDesc& object, const std::string& material, bool needsTangents) {
        const auto set = [&](auto& shape) {
            if constexpr (requires { shape.material; }) shape.material = material;
        };
        std::visit(set, object.shape);
        auto* mesh = std::get_if<MeshDesc>(&object.shape);
        if (!mesh || !needsTangents) return;
        if (const auto* single = std::get_if<Boxed<FloatMeshData>>(&mesh->source))
            mesh->source = (*single)->as<double>();
        MeshData* data = std::get<Boxed<MeshData>>(mesh->source).own(); // the shape was made just now
        if (data != nullptr && !data->uvs.empty()) addTangents(*data, 0);
    }

    // Into the object that is being defined, else into the world.
    void addObjects(std::vector<ObjectDesc> objects, const Affine& toWorld) {
        if (objects.empty()) return;
        std::vector<ObjectDesc>& all = object_ ? object_->objects : scene_.objects;
        const Affine map = object_ ? toWorld : mirror_ * toWorld;
        all.push_back({GroupDesc{toTransform(map), std::move(objects)}});
    }

    void beginObject(const PbrtDirective& d) {
        if (object_) d.place.fail("ObjectBegin must not stand within another");
        if (objects_.count(d.texts[0]) > 0) d.parameters.fail("the object is defined already");
        object_ = Object{d.texts[0], d.place, {}};
        saved_.push_back({state_, "ObjectBegin", d.place});
    }

    void endObject(const PbrtDirective& d) {
        if (!object_) d.place.fail("ObjectEnd has no begin");
        if (saved_.empty() || saved_.back().name != "ObjectBegin")
            d.place.fail("ObjectEnd stands within what has no end");
        state_ = std::move(saved_.back().state);
        saved_.pop_back();
        parser_.setColorSpace(state_.space);
        std::string key;
        if (!object_->objects.empty()) {
            key = names_.unique(object_->name, "object", objects_.size());
            scene_.prototypes[key] = std::move(object_->objects);
        }
        objects_[object_->name] = key;
        object_.reset();
    }

    void addInstance(const PbrtDirective& d) {
        if (object_) d.place.fail("ObjectInstance must not stand within ObjectBegin");
        const auto found = objects_.find(d.texts[0]);
        if (found == objects_.end()) d.parameters.fail("is not defined by any ObjectBegin before");
        const Affine map = mirror_ * checked(d);
        if (state_.moves()) notices_.add("motion is left out: all stands where it is at the start", d.place);
        if (!inverse(map)) return notices_.add("shapes are left out whose transform cannot be inverted", d.place);
        if (!found->second.empty()) scene_.objects.push_back({InstanceDesc{found->second, toTransform(map), {}}});
    }

    // Mirrored cells are even where they were odd: those of floor(-x).
    void swapCheckers() {
        for (auto& [name, texture] : scene_.textures)
            if (auto* checker = std::get_if<CheckerTexture>(&texture)) std::swap(checker->even, checker->odd);
    }

    const fs::path path_;
    SceneDesc scene_;
    PbrtNotices notices_;
    PbrtBudget budget_;
    PbrtFiles files_;
    PbrtTextures textures_{scene_, files_, notices_};
    PbrtMaterials materials_{scene_, files_, textures_, notices_};
    PbrtShapes shapes_{files_, budget_, notices_};
    PbrtLights lights_{scene_, files_, textures_, notices_};
    PbrtMedia media_{files_, notices_};
    PbrtParser parser_{
        budget_, [this](const std::string& name, const PbrtPlace& place) { return files_.existing(name, place); }};
    PbrtView view_;
    Affine mirror_;
    bool inWorld_ = false;
    PbrtState state_;
    std::vector<Saved> saved_;
    std::map<std::string, PbrtTransforms> systems_;
    std::vector<std::string> methods_;           // of pbrt
    std::optional<Object> object_;               // that is being defined
    std::map<std::string, std::string> objects_; // prototypes by name; empty: there is nothing in it
    UniqueNames names_;
};

} // namespace

SceneDesc loadPbrtScene(const fs::path& path) {
    return PbrtLoader(path).run();
}

} // namespace rt::scene
