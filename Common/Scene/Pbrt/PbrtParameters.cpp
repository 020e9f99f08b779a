#include "Common/Scene/Pbrt/PbrtParameters.h"

#include <array>
#include <cmath>
#include <locale>
#include <sstream>
#include <utility>

#include "Common/Core/Printable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

namespace {

constexpr std::array<std::pair<std::string_view, PbrtType>, 19> kPbrtTypeNames = {{
    {"float", PbrtType::Number},        {"integer", PbrtType::Integer}, {"string", PbrtType::Text},
    {"bool", PbrtType::Bool},           {"point2", PbrtType::Point2},   {"vector2", PbrtType::Point2},
    {"point3", PbrtType::Vector3},      {"vector3", PbrtType::Vector3}, {"normal", PbrtType::Vector3},
    {"normal3", PbrtType::Vector3},     {"point", PbrtType::Vector3},   {"vector", PbrtType::Vector3},
    {"spectrum", PbrtType::Spectrum},   {"rgb", PbrtType::Rgb},         {"color", PbrtType::Rgb},
    {"blackbody", PbrtType::Blackbody}, {"texture", PbrtType::Texture}, {"number", PbrtType::Number},
    {"boolean", PbrtType::Bool},
}};

const char* describe(PbrtType type) {
    switch (type) {
        case PbrtType::Number:
            return "float";
        case PbrtType::Integer:
            return "integer";
        case PbrtType::Text:
            return "string";
        case PbrtType::Bool:
            return "bool";
        case PbrtType::Point2:
            return "point2";
        case PbrtType::Vector3:
            return "point3, vector3 or normal";
        case PbrtType::Spectrum:
            return "spectrum";
        case PbrtType::Rgb:
            return "rgb";
        case PbrtType::Blackbody:
            return "blackbody";
        case PbrtType::Texture:
            break;
    }
    return "texture";
}

void expectOne(const PbrtParameter& parameter, std::size_t count) {
    if (count != 1) parameter.fail("has " + counted(count, "value", "values") + ": must have 1");
}

template <int N, class Real>
std::vector<glm::vec<N, Real>> taken(const PbrtParameter& parameter, const char* each) {
    const std::size_t count = parameter.count();
    if (count == 0 || count % N != 0)
        parameter.fail("has " + counted(count, "number", "numbers") + ": must have " + each + " for each");
    std::vector<glm::vec<N, Real>> values;
    values.reserve(count / N);
    glm::vec<N, Real> value(0);
    int place = 0;
    const auto add = [&](auto number) {
        value[place++] = static_cast<Real>(number);
        if (place < N) return;
        values.push_back(value);
        place = 0;
    };
    for (const double number : std::exchange(parameter.numbers, {})) add(number);
    parameter.longList.drain(add);
    return values;
}

} // namespace

void PbrtParameter::addNumber(double number) {
    const bool mayBeLong = type == PbrtType::Vector3 || type == PbrtType::Point2 || type == PbrtType::Number;
    if (longList.size() == 0 && (!mayBeLong || numbers.size() < kShortList)) return numbers.push_back(number);
    for (const double before : std::exchange(numbers, {})) longList.push_back(before);
    longList.push_back(number);
}

const char* const kPbrtTypes =
    "float, integer, string, bool, point2, vector2, point3, vector3, normal, spectrum, rgb, blackbody, texture";

std::optional<PbrtType> pbrtTypeOf(std::string_view name) {
    for (const auto& [known, type] : kPbrtTypeNames)
        if (known == name) return type;
    return std::nullopt;
}

double pbrtFinite(const PbrtParameter& parameter, double value) {
    if (!(std::abs(value) <= kLargest)) parameter.fail("must be from -1e9 to 1e9");
    return value;
}

const PbrtParameter* PbrtParameters::find(std::string_view name) const {
    const PbrtParameter* first = nullptr;
    for (const PbrtParameter& parameter : list) {
        if (parameter.name != name) continue;
        parameter.isUsed = true;
        if (!first) first = &parameter;
    }
    return first;
}

const PbrtParameter* PbrtParameters::find(std::string_view name, PbrtType type) const {
    const PbrtParameter* found = find(name);
    if (found && found->type != type) found->fail(std::string("must be of type ") + describe(type));
    return found;
}

double PbrtParameters::number(std::string_view name, double usual) const {
    const PbrtParameter* found = find(name, PbrtType::Number);
    if (!found) return usual;
    expectOne(*found, found->count());
    return pbrtFinite(*found, found->numbers.front());
}

double PbrtParameters::number(std::string_view name, double usual, double least, double most) const {
    const double value = number(name, usual);
    if (value == usual || (value >= least && value <= most)) return value;
    const auto text = [](double number) {
        std::ostringstream digits;
        digits.imbue(std::locale::classic());
        digits << number;
        return digits.str();
    };
    find(name)->fail(text(value) + ": must be from " + text(least) + " to " + text(most));
}

int PbrtParameters::integer(std::string_view name, int usual) const {
    const PbrtParameter* found = find(name, PbrtType::Integer);
    if (!found) return usual;
    expectOne(*found, found->integers.size());
    return found->integers.front();
}

bool PbrtParameters::boolean(std::string_view name, bool usual) const {
    const PbrtParameter* found = find(name, PbrtType::Bool);
    if (!found) return usual;
    expectOne(*found, found->integers.size());
    return found->integers.front() != 0;
}

std::string PbrtParameters::string(std::string_view name, const std::string& usual) const {
    const PbrtParameter* found = find(name, PbrtType::Text);
    if (!found) return usual;
    expectOne(*found, found->texts.size());
    return found->texts.front();
}

std::string PbrtParameters::oneOf(std::string_view name, const std::string& usual,
                                  std::initializer_list<const char*> allowed) const {
    std::string value = string(name, usual);
    std::string all;
    for (const char* known : allowed) {
        if (value == known) return value;
        all += (all.empty() ? "" : ", ") + std::string(known);
    }
    if (value == usual) return value;
    find(name)->fail('"' + printable(value, 100) + "\" is unknown; known are " + all);
}

glm::dvec3 PbrtParameters::vector(std::string_view name, const glm::dvec3& usual) const {
    const PbrtParameter* found = find(name, PbrtType::Vector3);
    if (!found) return usual;
    if (found->count() != 3) found->fail("has " + counted(found->count(), "number", "numbers") + ": must have 3");
    for (const double number : found->numbers) pbrtFinite(*found, number);
    return {found->numbers[0], found->numbers[1], found->numbers[2]};
}

template <class Real>
std::vector<glm::vec<3, Real>> PbrtParameters::takeVectors(std::string_view name) const {
    const PbrtParameter* found = find(name, PbrtType::Vector3);
    return found ? taken<3, Real>(*found, "three") : std::vector<glm::vec<3, Real>>();
}

// Files of earlier versions give these as floats.
template <class Real>
std::vector<glm::vec<2, Real>> PbrtParameters::takePairs(std::string_view name) const {
    const PbrtParameter* found = find(name);
    if (found && found->type != PbrtType::Number) found = find(name, PbrtType::Point2);
    return found ? taken<2, Real>(*found, "two") : std::vector<glm::vec<2, Real>>();
}

template std::vector<glm::dvec3> PbrtParameters::takeVectors<double>(std::string_view) const;
template std::vector<glm::vec3> PbrtParameters::takeVectors<float>(std::string_view) const;
template std::vector<glm::dvec2> PbrtParameters::takePairs<double>(std::string_view) const;
template std::vector<glm::vec2> PbrtParameters::takePairs<float>(std::string_view) const;

bool PbrtParameters::isLong(std::string_view name) const {
    const PbrtParameter* found = find(name);
    return found && found->longList.size() > 0;
}

std::vector<const PbrtParameter*> PbrtParameters::unused() const {
    std::vector<const PbrtParameter*> left;
    for (const PbrtParameter& parameter : list)
        if (!parameter.isUsed) left.push_back(&parameter);
    return left;
}

} // namespace rt::scene
