// The grammar of pbrt files: directives with what follows each.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "Common/Scene/Pbrt/PbrtBudget.h"
#include "Common/Scene/Pbrt/PbrtLexer.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"

namespace rt::scene {

enum class PbrtKeyword {
    Accelerator,
    ActiveTransform,
    AreaLightSource,
    Attribute,
    AttributeBegin,
    AttributeEnd,
    Camera,
    ColorSpace,
    ConcatTransform,
    CoordinateSystem,
    CoordSysTransform,
    Film,
    Identity,
    Import,
    Include,
    Integrator,
    LightSource,
    LookAt,
    MakeNamedMaterial,
    MakeNamedMedium,
    Material,
    MediumInterface,
    NamedMaterial,
    ObjectBegin,
    ObjectEnd,
    ObjectInstance,
    Option,
    PixelFilter,
    ReverseOrientation,
    Rotate,
    Sampler,
    Scale,
    Shape,
    Texture,
    Transform,
    TransformBegin,
    TransformEnd,
    TransformTimes,
    Translate,
    WorldBegin,
};

struct PbrtDirective {
    PbrtKeyword keyword;
    std::string_view name;          // of the keyword
    std::vector<std::string> texts; // strings before the parameters, and the word behind ActiveTransform
    std::vector<double> numbers;
    PbrtParameters parameters; // what: the name and the first of the texts
    PbrtPlace place;
};

// Reads a file; what it includes is read in its place.
class PbrtParser {
  public:
    // What a file that is named in another means; throws InputError where there is none.
    using Locate = std::function<std::filesystem::path(const std::string& name, const PbrtPlace& place)>;

    PbrtParser(PbrtBudget& budget, Locate locate) : budget_(budget), locate_(std::move(locate)) {}

    // Calls `handle` for each directive but Include; that of Import comes before those of its file, and one of
    // AttributeEnd without a place after them. Throws InputError.
    template <class Handle>
    void read(const std::filesystem::path& path, const Handle& handle) {
        for (open(path, {}); !files_.empty();) {
            if (!next()) {
                const bool wasImported = files_.back().isImported;
                close();
                if (wasImported) handle(endOfImport());
                continue;
            }
            if (directive_.keyword != PbrtKeyword::Include) handle(directive_);
            if (directive_.keyword == PbrtKeyword::Include || directive_.keyword == PbrtKeyword::Import)
                open(locate_(directive_.texts.front(), directive_.place), directive_);
        }
    }

    // The colour space that "rgb" is read in from here on.
    void setColorSpace(const PbrtColorSpace* space) { space_ = space; }

  private:
    struct File {
        std::unique_ptr<PbrtLexer> lexer;
        std::filesystem::path path;
        bool isImported;
    };

    void open(const std::filesystem::path& path, const PbrtDirective& from);
    void close() { files_.pop_back(); }
    bool next(); // false: the file ends
    PbrtDirective& endOfImport();
    void readTexts(std::size_t least, std::size_t most);
    void readNumbers(std::size_t count);
    void readParameters();
    void skipValue();
    void readValues(PbrtParameter& parameter);
    void addValue(PbrtParameter& parameter);
    PbrtLexer& lexer() { return *files_.back().lexer; }

    PbrtBudget& budget_;
    Locate locate_;
    std::vector<File> files_; // each included by the one before
    std::vector<std::filesystem::path> known_;
    PbrtDirective directive_{};
    const PbrtColorSpace* space_ = nullptr;
};

} // namespace rt::scene
