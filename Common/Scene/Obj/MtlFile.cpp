#include "Common/Scene/Obj/MtlFile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <locale>
#include <map>
#include <sstream>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Scene/Obj/ObjText.h"

namespace rt::scene {

namespace {

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

// The finite number that the whole text is, with a decimal point in any locale; what is too large is the largest there
// is.
std::optional<double> numberOf(std::string_view text) {
    if (text.empty() || text.find_first_not_of("+-.0123456789eE") != text.npos) return std::nullopt;
    std::istringstream stream{std::string(text)};
    stream.imbue(std::locale::classic());
    double value = 0;
    stream >> value;
    if (stream.fail()) return std::abs(value) > 1 ? std::optional(value) : std::nullopt;
    return stream.peek() == std::istringstream::traits_type::eof() ? std::optional(value) : std::nullopt;
}

// One statement: its keyword and what follows.
class Statement {
  public:
    Statement(std::string_view line, std::string place) : rest_(line), place_(std::move(place)) {
        place_ += ": " + std::string(peek());
        keyword_ = lowerCase(next());
    }
    const std::string& keyword() const { return keyword_; }

    std::string_view peek() const { return rest_.substr(0, rest_.find_first_of(" \t\r")); }
    std::string_view next() {
        const std::string_view word = peek();
        rest_ = trimmed(rest_.substr(word.size()));
        return word;
    }
    std::string_view rest() const { return rest_; }

    double number() {
        const std::string_view word = next();
        const std::optional<double> value = numberOf(word);
        if (word.empty()) throw InputError(place_ + ": a number is missing");
        if (!value) throw InputError(place_ + ": \"" + std::string(word) + "\" is not a finite number");
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
        if (rest_.empty() || rest_.front() == '#') return glm::dvec3(first);
        const double second = number();
        return {first, second, number()};
    }

  private:
    std::string_view rest_;
    std::string place_, keyword_;
};

// Options, each with what follows it, and the file's name, which may hold spaces.
MtlMap readMap(Statement& statement) {
    MtlMap map;
    while (!statement.rest().empty() && statement.peek().front() == '-') {
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
    map.file = statement.rest();
    return map;
}

// ---- statements ----------------------------------------------------------------------------------------------------

using Action = void (*)(Statement&, MtlMaterial&);

template <auto member>
void readColor(Statement& statement, MtlMaterial& material) {
    const std::string kind = lowerCase(statement.peek());
    if (kind == "spectral" || kind == "xyz")
        material.leftOut.push_back("a colour by its spectrum or in CIE XYZ");
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
        material.leftOut.push_back("the dependence of opacity on direction (-halo)");
        statement.next();
    }
    material.opacity = statement.number();
}

// Of those who do not write d.
void readTransparency(Statement& statement, MtlMaterial& material) {
    const double transparency = statement.number();
    if (!material.opacity) material.opacity = 1 - transparency;
}

void readIllumination(Statement& statement, MtlMaterial& material) {
    material.illumination = static_cast<int>(std::clamp(statement.number(), -1.0, 100.0));
}

void readAnisotropy(Statement& statement, MtlMaterial& material) {
    if (statement.number() != 0) material.leftOut.push_back("anisotropy (aniso)");
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

std::vector<MtlMaterial> readMtl(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = readText(path);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::vector<MtlMaterial> materials;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        const std::string_view content = trimmed(text.substr(0, end));
        const bool isPair = text.substr(end, 2) == "\r\n";
        text.remove_prefix(std::min(end + (isPair ? 2 : 1), text.size()));
        if (content.empty() || content.front() == '#') continue;
        Statement statement(content, path.string() + ":" + std::to_string(line));
        if (statement.keyword() == "newmtl") {
            materials.emplace_back();
            materials.back().name = statement.rest();
            continue;
        }
        const auto action = actions().find(statement.keyword());
        if (action != actions().end() && !materials.empty()) action->second(statement, materials.back());
    }
    std::erase_if(materials, [](const MtlMaterial& material) { return material.name.empty(); });
    return materials;
}

} // namespace rt::scene
