#include "Common/Scene/Obj/MtlFile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Obj/ObjText.h"

namespace rt::scene {

namespace {

// One statement: its keyword and what follows.
class Statement {
  public:
    explicit Statement(std::string_view line) : rest_(line), keyword_(peek()) { next(); }
    const std::string& keyword() const { return keyword_; } // as it is written

    std::string_view peek() const {
        std::string_view text = rest_;
        return takeWord(text);
    }
    std::string_view next() {
        const std::string_view word = takeWord(rest_);
        rest_ = trimmed(rest_);
        return word;
    }
    std::string_view rest() const { return rest_; }

    // Throws InputError, as do those that follow, without its place.
    double number() {
        const std::string_view word = next();
        const std::optional<double> value = numberOf(word);
        if (word.empty()) throw InputError(keyword_ + ": a number is missing");
        if (!value) throw InputError(keyword_ + ": \"" + printable(word, kShown) + "\" is not a finite number");
        return *value;
    }
    // Up to `most` numbers, as long as words are some.
    std::vector<double> numbers(std::size_t maximum) {
        std::vector<double> values;
        while (values.size() < maximum && numberOf(peek())) values.push_back(number());
        return values;
    }
    // Three components, or one that counts for all.
    glm::dvec3 color() {
        const double first = number();
        if (peek().empty()) return glm::dvec3(first);
        const double second = number();
        return {first, second, number()};
    }

  private:
    static constexpr std::size_t kShown = 60; // bytes of what is quoted

    std::string_view rest_;
    std::string keyword_;
};

// Options, each with what follows it, and the file's name, which may hold spaces.
MtlMap readMap(Statement& statement) {
    MtlMap map;
    while (statement.peek().substr(0, 1) == "-") {
        const std::string option = lowerCase(statement.peek());
        const auto pair = [&](double usual) {
            statement.next();
            const std::vector<double> numbers = statement.numbers(3);
            return glm::dvec2(numbers.empty() ? usual : numbers[0], numbers.size() > 1 ? numbers[1] : usual);
        };
        if (option == "-o") {
            map.offset = pair(0);
        } else if (option == "-s") {
            map.scale = pair(1);
        } else if (option == "-t" || option == "-mm" || option == "-boost" || option == "-texres") {
            pair(0);
        } else if (option == "-bm") {
            statement.next();
            map.strength = statement.number();
        } else if (option == "-clamp") {
            statement.next();
            map.isClamped = lowerCase(statement.next()) == "on";
        } else if (option == "-imfchan") {
            statement.next();
            const std::string channel = lowerCase(statement.next());
            map.channel = channel.empty() ? '\0' : channel.front();
        } else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-type" ||
                   option == "-colorspace") {
            statement.next();
            statement.next();
        } else {
            break; // a name that begins like an option
        }
    }
    if (!withoutComment(statement.rest()).empty()) map.file = statement.rest();
    return map;
}

// ---- statements ----------------------------------------------------------------------------------------------------

using Action = void (*)(Statement&, MtlMaterial&);

template <auto member>
void readColor(Statement& statement, MtlMaterial& material) {
    const std::string kind = lowerCase(statement.peek());
    if (kind == "spectral" || kind == "xyz")
        material.leftOut.emplace_back("a colour by its spectrum or in CIE XYZ");
    else
        material.*member = statement.color();
}

template <auto member>
void readNumber(Statement& statement, MtlMaterial& material) {
    material.*member = statement.number();
}

template <auto member>
void readImage(Statement& statement, MtlMaterial& material) {
    material.*member = readMap(statement);
}

void readOpacity(Statement& statement, MtlMaterial& material) {
    if (statement.peek() == "-halo") {
        material.leftOut.emplace_back("the dependence of opacity on direction (-halo)");
        statement.next();
    }
    material.opacity = statement.number();
}

// Of those who do not write d.
void readTransparency(Statement& statement, MtlMaterial& material) {
    const double transparency = statement.number();
    if (!material.opacity) material.opacity = 1 - transparency;
}

constexpr int kLastModel = 10; // of illumination

void readIllumination(Statement& statement, MtlMaterial& material) {
    const double model = statement.number();
    if (!(model >= 0 && model <= kLastModel && model == std::floor(model)))
        throw InputError(statement.keyword() + ": the models of illumination are 0 to " + std::to_string(kLastModel));
    material.illumination = static_cast<int>(model);
    if (model == kLastModel) material.leftOut.emplace_back("that only shadows are seen (illum 10)");
}

void readAnisotropy(Statement& statement, MtlMaterial& material) {
    if (statement.number() != 0) material.leftOut.emplace_back("anisotropy (aniso)");
}

template <const auto& what>
void leaveOut(Statement& statement, MtlMaterial& material) {
    if (readMap(statement)) material.leftOut.push_back(what);
}
constexpr char kExponentMap[] = "the map of highlights (map_Ns)";
constexpr char kDisplacement[] = "the displacement (disp)";
constexpr char kDecal[] = "the decal (decal)";
constexpr char kReflection[] = "the reflection map (refl)";

const std::map<std::string, Action>& actions() {
    using M = MtlMaterial;
    static const std::map<std::string, Action> table = {
        {"kd", readColor<&M::diffuse>},
        {"ks", readColor<&M::specular>},
        {"ke", readColor<&M::emission>},
        {"tf", readColor<&M::filter>},
        {"kt", readColor<&M::filter>},
        {"ns", readNumber<&M::exponent>},
        {"ni", readNumber<&M::ior>},
        {"d", readOpacity},
        {"tr", readTransparency},
        {"illum", readIllumination},
        {"pr", readNumber<&M::roughness>},
        {"pm", readNumber<&M::metallic>},
        {"ps", readNumber<&M::sheen>},
        {"pc", readNumber<&M::clearcoat>},
        {"pcr", readNumber<&M::clearcoatRoughness>},
        {"aniso", readAnisotropy},
        {"map_kd", readImage<&M::diffuseMap>},
        {"map_ks", readImage<&M::specularMap>},
        {"map_ke", readImage<&M::emissionMap>},
        {"map_d", readImage<&M::opacityMap>},
        {"norm", readImage<&M::normalMap>},
        {"map_bump", readImage<&M::bumpMap>},
        {"bump", readImage<&M::bumpMap>},
        {"map_pr", readImage<&M::roughnessMap>},
        {"map_pm", readImage<&M::metallicMap>},
        {"map_ps", readImage<&M::sheenMap>},
        {"map_ns", leaveOut<kExponentMap>},
        {"disp", leaveOut<kDisplacement>},
        {"map_disp", leaveOut<kDisplacement>},
        {"decal", leaveOut<kDecal>},
        {"refl", leaveOut<kReflection>},
    };
    return table;
}

} // namespace

std::vector<MtlMaterial> readMtl(const std::filesystem::path& path, std::vector<std::string>& notices) {
    const std::vector<std::byte> bytes = readText(path);
    std::vector<MtlMaterial> materials;
    std::string firstError;
    std::size_t errors = 0;
    for (TextLines lines({reinterpret_cast<const char*>(bytes.data()), bytes.size()}); lines.next();) {
        interruptionPoint();
        Statement statement(lines.line());
        const std::string keyword = lowerCase(statement.keyword());
        if (keyword == "newmtl") {
            materials.emplace_back();
            materials.back().name = nameIn(statement.rest());
            continue;
        }
        const auto action = actions().find(keyword);
        if (action == actions().end() || materials.empty()) continue;
        try {
            action->second(statement, materials.back());
        } catch (const InputError& error) {
            if (errors++ == 0) firstError = path.string() + ":" + std::to_string(lines.number()) + ": " + error.what();
        }
    }
    if (errors > 0)
        notices.push_back(firstError + "; " + counted(errors, "statement is", "statements are") + " left out");
    std::erase_if(materials, [](const MtlMaterial& material) { return material.name.empty(); });
    return materials;
}

} // namespace rt::scene
