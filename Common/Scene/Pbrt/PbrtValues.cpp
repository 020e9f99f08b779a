#include "Common/Scene/Pbrt/PbrtValues.h"

#include <optional>
#include <string>

#include <glm/common.hpp>

#include "Common/Core/Printable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Obj/ObjText.h"
#include "Common/Scene/Pbrt/PbrtBudget.h"
#include "Common/Scene/Pbrt/PbrtColor.h"
#include "Common/Scene/Pbrt/PbrtLexer.h"

namespace rt::scene {

namespace {

glm::dvec3 rgbOf(const PbrtParameter& parameter) {
    if (parameter.numbers.size() != 3)
        parameter.fail("has " + counted(parameter.numbers.size(), "number", "numbers") + ": must have 3");
    const glm::dvec3 rgb(parameter.numbers[0], parameter.numbers[1], parameter.numbers[2]);
    for (int c = 0; c < 3; ++c)
        if (!(rgb[c] >= 0 && rgb[c] <= kLargest)) parameter.fail("must be from 0 to 1e9");
    return rgb;
}

glm::dvec3 blackbodyOf(const PbrtParameter& parameter) {
    if (parameter.numbers.size() != 1)
        parameter.fail("has " + counted(parameter.numbers.size(), "number", "numbers") + ": must have 1");
    const double kelvin = parameter.numbers.front();
    if (!(kelvin >= 500 && kelvin <= 1e6)) parameter.fail("must be from 500 to 1e6, in Kelvin");
    return pbrtBlackbody(kelvin);
}

PbrtSpectrum sampled(const std::vector<double>& numbers, const PbrtParameter& parameter) {
    if (numbers.empty() || numbers.size() % 2 != 0) parameter.fail("must be pairs of a wavelength and a value");
    PbrtSpectrum spectrum;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        if (i > 0 && !(numbers[i] > numbers[i - 2])) parameter.fail("its wavelengths must grow");
        if (!(numbers[i] >= 0 && numbers[i] <= kLargest)) parameter.fail("its wavelengths must be from 0 to 1e9");
        spectrum.samples.emplace_back(numbers[i], pbrtFinite(parameter, numbers[i + 1]));
    }
    return spectrum;
}

PbrtSpectrum readSpectrum(const PbrtParameter& parameter, PbrtFiles& files) {
    PbrtBudget budget;
    PbrtLexer lexer(files.existing(parameter.texts.front(), parameter.place), budget);
    std::vector<double> numbers;
    while (lexer.next() != PbrtLexer::Kind::End) {
        const std::optional<double> number = numberOf(lexer.text());
        if (!number) lexer.place().fail(lexer.described() + ": must be a number");
        numbers.push_back(*number);
    }
    return sampled(numbers, parameter);
}

const std::string* nameIn(const PbrtParameter& parameter) {
    if (parameter.type != PbrtType::Spectrum || parameter.texts.empty()) return nullptr;
    if (parameter.texts.size() != 1 || !parameter.numbers.empty()) parameter.fail("must have one name");
    return &parameter.texts.front();
}

} // namespace

double pbrtNumber(const PbrtParameter& parameter) {
    if (parameter.type != PbrtType::Number || parameter.numbers.size() != 1)
        parameter.fail("must be one float, or a texture of floats");
    return pbrtFinite(parameter, parameter.numbers.front());
}

PbrtSpectrum pbrtSpectrum(const PbrtParameter& parameter, PbrtFiles& files) {
    const std::string* name = nameIn(parameter);
    if (!name) return sampled(parameter.numbers, parameter);
    if (std::optional<PbrtSpectrum> metal = pbrtMetal(*name)) return *metal;
    if (const std::optional<double> glass = pbrtGlass(*name)) return {{{300, *glass}, {900, *glass}}};
    const bool isFile = name->find('.') != name->npos || name->find('/') != name->npos;
    if (!isFile)
        parameter.fail('"' + printable(*name, 100) + "\" is unknown; known are metal-M-eta and metal-M-k of " +
                       kPbrtMetals + "; glass-G of " + kPbrtGlasses + "; of light " + kPbrtIlluminants +
                       "; and files with an ending");
    return readSpectrum(parameter, files);
}

glm::dvec3 pbrtLight(const PbrtParameter& parameter, PbrtFiles& files) {
    if (parameter.type == PbrtType::Rgb) return pbrtLightOf(parameter.space, rgbOf(parameter));
    if (parameter.type == PbrtType::Blackbody) return blackbodyOf(parameter);
    if (parameter.type != PbrtType::Spectrum) parameter.fail("must be of type rgb, blackbody or spectrum");
    if (const std::string* name = nameIn(parameter))
        if (const std::optional<glm::dvec3> illuminant = pbrtIlluminant(*name)) return *illuminant;
    return glm::min(pbrtLightOf(pbrtSpectrum(parameter, files)), glm::dvec3(kLargest));
}

glm::dvec3 pbrtReflectance(const PbrtParameter& parameter, PbrtFiles& files) {
    if (parameter.type == PbrtType::Rgb)
        return glm::clamp(pbrtReflectanceOf(parameter.space, rgbOf(parameter)), 0.0, 1.0);
    if (parameter.type == PbrtType::Number) return glm::clamp(glm::dvec3(pbrtNumber(parameter)), 0.0, 1.0);
    if (parameter.type != PbrtType::Spectrum) parameter.fail("must be of type rgb, spectrum or texture");
    return pbrtReflectanceOf(pbrtSpectrum(parameter, files));
}

double pbrtIndex(const PbrtParameter& parameter, PbrtFiles& files) {
    if (parameter.type == PbrtType::Number) return pbrtNumber(parameter);
    if (parameter.type == PbrtType::Rgb) {
        const glm::dvec3 rgb = rgbOf(parameter);
        return (rgb.x + rgb.y + rgb.z) / 3;
    }
    if (parameter.type != PbrtType::Spectrum) parameter.fail("must be of type float or spectrum");
    return pbrtSpectrum(parameter, files).at(587.6);
}

} // namespace rt::scene
