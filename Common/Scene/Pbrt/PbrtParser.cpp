#include "Common/Scene/Pbrt/PbrtParser.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>

#include "Common/Core/Printable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Obj/ObjText.h"

namespace rt::scene {

namespace {

// What follows a keyword.
struct PbrtForm {
    std::string_view name;
    PbrtKeyword keyword;
    std::size_t minTexts = 0, maxTexts = 0, numbers = 0;
    bool hasParameters = false;
};

using K = PbrtKeyword;
constexpr PbrtForm kForms[] = {
    {"Accelerator", K::Accelerator, 1, 1, 0, true},
    {"ActiveTransform", K::ActiveTransform, 1, 1, 0, false}, // its word is not quoted
    {"AreaLightSource", K::AreaLightSource, 1, 1, 0, true},
    {"Attribute", K::Attribute, 1, 1, 0, true},
    {"AttributeBegin", K::AttributeBegin, 0, 0, 0, false},
    {"AttributeEnd", K::AttributeEnd, 0, 0, 0, false},
    {"Camera", K::Camera, 1, 1, 0, true},
    {"ColorSpace", K::ColorSpace, 1, 1, 0, false},
    {"ConcatTransform", K::ConcatTransform, 0, 0, 16, false},
    {"CoordinateSystem", K::CoordinateSystem, 1, 1, 0, false},
    {"CoordSysTransform", K::CoordSysTransform, 1, 1, 0, false},
    {"Film", K::Film, 1, 1, 0, true},
    {"Identity", K::Identity, 0, 0, 0, false},
    {"Import", K::Import, 1, 1, 0, false},
    {"Include", K::Include, 1, 1, 0, false},
    {"Integrator", K::Integrator, 1, 1, 0, true},
    {"LightSource", K::LightSource, 1, 1, 0, true},
    {"LookAt", K::LookAt, 0, 0, 9, false},
    {"MakeNamedMaterial", K::MakeNamedMaterial, 1, 1, 0, true},
    {"MakeNamedMedium", K::MakeNamedMedium, 1, 1, 0, true},
    {"Material", K::Material, 1, 1, 0, true},
    {"MediumInterface", K::MediumInterface, 1, 2, 0, false},
    {"NamedMaterial", K::NamedMaterial, 1, 1, 0, false},
    {"ObjectBegin", K::ObjectBegin, 1, 1, 0, false},
    {"ObjectEnd", K::ObjectEnd, 0, 0, 0, false},
    {"ObjectInstance", K::ObjectInstance, 1, 1, 0, false},
    {"Option", K::Option, 1, 1, 0, false}, // and a value
    {"PixelFilter", K::PixelFilter, 1, 1, 0, true},
    {"ReverseOrientation", K::ReverseOrientation, 0, 0, 0, false},
    {"Rotate", K::Rotate, 0, 0, 4, false},
    {"Sampler", K::Sampler, 1, 1, 0, true},
    {"Scale", K::Scale, 0, 0, 3, false},
    {"Shape", K::Shape, 1, 1, 0, true},
    {"Texture", K::Texture, 3, 3, 0, true},
    {"Transform", K::Transform, 0, 0, 16, false},
    {"TransformBegin", K::TransformBegin, 0, 0, 0, false},
    {"TransformEnd", K::TransformEnd, 0, 0, 0, false},
    {"TransformTimes", K::TransformTimes, 0, 0, 2, false},
    {"Translate", K::Translate, 0, 0, 3, false},
    {"WorldBegin", K::WorldBegin, 0, 0, 0, false},
};

const PbrtForm& formOf(const PbrtLexer& lexer) {
    if (lexer.kind() == PbrtLexer::Kind::Word) {
        const auto hasName = [&](const PbrtForm& form) { return form.name == lexer.text(); };
        if (const auto* form = std::ranges::find_if(kForms, hasName); form != std::end(kForms)) return *form;
    }
    std::string known;
    for (const PbrtForm& form : kForms) known += (known.empty() ? "" : ", ") + std::string(form.name);
    lexer.place().fail(lexer.described() + " is no directive; known are " + known);
}

double toNumber(const PbrtLexer& lexer) {
    const std::optional<double> value = lexer.kind() == PbrtLexer::Kind::Word ? numberOf(lexer.text()) : std::nullopt;
    if (!value) lexer.place().fail(lexer.described() + ": must be a number");
    return *value;
}

constexpr std::size_t kMaxIncludeDepth = 64;
constexpr std::uint64_t kElementsOfFile = 256;

} // namespace

void PbrtParser::open(const std::filesystem::path& path, const PbrtDirective& from) {
    const auto isSame = [&path](const File& file) { return file.path == path; };
    if (std::ranges::any_of(files_, isSame)) from.place.fail("\"" + printable(path.string()) + "\" includes itself");
    if (files_.size() == kMaxIncludeDepth)
        from.place.fail("files include each other deeper than " + std::to_string(kMaxIncludeDepth));
    if (!files_.empty()) budget_.spend(kElementsOfFile, from.place); // its opening takes as long as they do
    auto lexer = std::make_unique<PbrtLexer>(path, budget_);
    if (std::ranges::find(known_, path) == known_.end()) {
        known_.push_back(path);
        budget_.add(lexer->bytes());
    }
    lexer->next();
    files_.push_back({std::move(lexer), path, !files_.empty() && from.keyword == PbrtKeyword::Import});
}

// The lexer always is at the first word that has not been read.
bool PbrtParser::next() {
    if (lexer().kind() == PbrtLexer::Kind::End) return false;
    const PbrtForm& form = formOf(lexer());
    directive_ = {};
    directive_.keyword = form.keyword;
    directive_.name = form.name;
    directive_.place = directive_.parameters.place = lexer().place();
    lexer().next();
    if (form.keyword == PbrtKeyword::ActiveTransform) {
        if (lexer().kind() == PbrtLexer::Kind::Word) directive_.texts.emplace_back(lexer().text());
        lexer().next();
        return true;
    }
    readTexts(form.minTexts, form.maxTexts);
    if (form.keyword == PbrtKeyword::Option) skipValue();
    readNumbers(form.numbers);
    directive_.parameters.what = form.name;
    if (!directive_.texts.empty()) directive_.parameters.what += " \"" + printable(directive_.texts.back(), 100) + '"';
    if (form.hasParameters) readParameters();
    return true;
}

PbrtDirective& PbrtParser::endOfImport() {
    directive_ = {};
    directive_.keyword = PbrtKeyword::AttributeEnd;
    return directive_;
}

void PbrtParser::readTexts(std::size_t least, std::size_t most) {
    while (directive_.texts.size() < most && lexer().kind() == PbrtLexer::Kind::Quoted) {
        directive_.texts.emplace_back(lexer().text());
        lexer().next();
    }
    if (directive_.texts.size() < least)
        lexer().place().fail(std::string(directive_.name) + ": " + lexer().described() +
                             ": must be a string in quotes");
}

void PbrtParser::readNumbers(std::size_t count) {
    if (count == 0) return;
    const bool isList = lexer().kind() == PbrtLexer::Kind::Open;
    if (isList) lexer().next();
    while (directive_.numbers.size() < count) {
        directive_.numbers.push_back(toNumber(lexer()));
        if (!std::isfinite(directive_.numbers.back())) lexer().place().fail("numbers must be finite");
        lexer().next();
    }
    if (!isList) return;
    if (lexer().kind() != PbrtLexer::Kind::Close)
        lexer().place().fail(lexer().described() + ": must be ], as " + std::string(directive_.name) + " has " +
                             counted(count, "number", "numbers"));
    lexer().next();
}

void PbrtParser::skipValue() {
    const bool isList = lexer().kind() == PbrtLexer::Kind::Open;
    if (isList) lexer().next();
    if (lexer().kind() != PbrtLexer::Kind::Word && lexer().kind() != PbrtLexer::Kind::Quoted)
        lexer().place().fail("Option: " + lexer().described() + ": must be a value");
    lexer().next();
    if (!isList) return;
    if (lexer().kind() != PbrtLexer::Kind::Close)
        lexer().place().fail(lexer().described() + ": must be ], as an option has one value");
    lexer().next();
}

// Behind an included file those of its last directive go on in the file that includes it.
void PbrtParser::readParameters() {
    for (;;) {
        while (lexer().kind() == PbrtLexer::Kind::End && files_.size() > 1 && !files_.back().isImported) close();
        if (lexer().kind() != PbrtLexer::Kind::Quoted) return;
        PbrtParameter parameter;
        parameter.place = lexer().place();
        std::string_view rest = lexer().text();
        parameter.typeName = std::string(takeWord(rest));
        parameter.name = std::string(trimmed(rest));
        const std::optional<PbrtType> type = pbrtTypeOf(parameter.typeName);
        if (!type || parameter.name.empty())
            lexer().place().fail(lexer().described() + ": must be a type and a name; types are " + kPbrtTypes);
        parameter.type = *type;
        parameter.typeName = printable(parameter.typeName, 100);
        parameter.space = space_;
        lexer().next();
        readValues(parameter);
        directive_.parameters.list.push_back(std::move(parameter));
    }
}

void PbrtParser::readValues(PbrtParameter& parameter) {
    const bool isList = lexer().kind() == PbrtLexer::Kind::Open;
    if (isList) lexer().next();
    do {
        if (isList && lexer().kind() == PbrtLexer::Kind::Close) break;
        addValue(parameter);
        lexer().next();
    } while (isList);
    if (isList) lexer().next();
}

void PbrtParser::addValue(PbrtParameter& parameter) {
    const auto refuse = [&](const char* expected) {
        lexer().place().fail(parameter.label() + ": " + lexer().described() + ": must be " + expected);
    };
    const bool isQuoted = lexer().kind() == PbrtLexer::Kind::Quoted;
    if (lexer().kind() != PbrtLexer::Kind::Word && !isQuoted) refuse("a value");
    const std::string_view text = lexer().text();
    switch (parameter.type) {
        case PbrtType::Text:
        case PbrtType::Texture:
            if (!isQuoted) refuse("a string in quotes");
            parameter.texts.emplace_back(text);
            return;
        case PbrtType::Bool:
            if (text != "true" && text != "false") refuse("true or false");
            parameter.integers.push_back(text == "true");
            return;
        case PbrtType::Integer: {
            std::int32_t value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            if (isQuoted || error != std::errc() || end != text.data() + text.size()) refuse("a whole number");
            parameter.integers.push_back(value);
            return;
        }
        case PbrtType::Spectrum:
            if (isQuoted) return void(parameter.texts.emplace_back(text));
            [[fallthrough]];
        default:
            break;
    }
    const std::optional<double> value = isQuoted ? std::nullopt : numberOf(text);
    if (!value) refuse("a number");
    parameter.addNumber(*value);
}

} // namespace rt::scene
