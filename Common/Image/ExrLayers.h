// Which channels of an OpenEXR file make the picture that is asked for.
#pragma once
#include <ImfMultiPartInputFile.h>
#include <cstddef>
#include <string>
#include <vector>

namespace rt::image {

inline constexpr std::size_t kMaxExrText = 200; // bytes of names in files and of messages that are shown

struct ExrChannels {
    enum class Kind { Color, LuminanceChroma, Other };

    int part = 0;
    std::vector<std::string> names; // three, or one
    Kind kind = Kind::Other;        // LuminanceChroma: Y, RY, BY
};

// Layers by which the picture can be asked for: what channels have before their last dot, and names of further parts.
std::vector<std::string> exrLayers(const Imf::MultiPartInputFile& file);

// Of the first part, or of a layer: R, G, B, or else Y with RY and BY, or Y alone; where there is no such thing outside
// of layers, the first layer of colours, with a warning; of a layer also X, Y, Z or the only
// channel that it has, or a single channel by its name. Throws InputError, naming `name` and what there is, when there
// is none.
ExrChannels chooseExrChannels(const Imf::MultiPartInputFile& file, const std::string& layer, const std::string& name);

} // namespace rt::image
