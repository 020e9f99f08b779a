#include "Common/Image/ExrLayers.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <algorithm>
#include <optional>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Printable.h"

namespace rt::image {

namespace {

using Kind = ExrChannels::Kind;

std::vector<std::string> channelsOf(const Imf::Header& header) {
    std::vector<std::string> names;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) names.emplace_back(i.name());
    return names;
}

std::string partName(const Imf::MultiPartInputFile& file, int part) {
    return file.header(part).hasName() ? file.header(part).name() : std::string();
}

std::string listed(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return printable(list, kMaxExrText);
}

// Channels of one part whose names begin with a prefix.
class ExrLayer {
  public:
    ExrLayer(const Imf::MultiPartInputFile& file, int part, std::string prefix)
        : channels_(file.header(part).channels()), part_(part), prefix_(std::move(prefix)) {}

    std::optional<ExrChannels> color() const { return these({"R", "G", "B"}, Kind::Color); }
    std::optional<ExrChannels> luminance() const {
        const auto withChroma = these({"Y", "RY", "BY"}, Kind::LuminanceChroma);
        return withChroma ? withChroma : these({"Y"}, Kind::Other);
    }
    std::optional<ExrChannels> vector() const { return these({"X", "Y", "Z"}, Kind::Other); }
    std::optional<ExrChannels> onlyOne() const {
        std::vector<std::string> found;
        for (auto i = channels_.begin(); i != channels_.end(); ++i)
            if (std::string(i.name()).starts_with(prefix_)) found.emplace_back(i.name());
        return found.size() == 1 ? std::optional(ExrChannels{part_, found, Kind::Other}) : std::nullopt;
    }

  private:
    std::optional<ExrChannels> these(const std::vector<std::string>& names, Kind kind) const {
        ExrChannels chosen{part_, {}, kind};
        for (const std::string& name : names) {
            if (channels_.findChannel(prefix_ + name) == nullptr) return std::nullopt;
            chosen.names.push_back(prefix_ + name);
        }
        return chosen;
    }

    const Imf::ChannelList& channels_;
    int part_;
    std::string prefix_;
};

std::optional<ExrChannels> chooseOf(const ExrLayer& layer) {
    if (auto found = layer.color()) return found;
    if (auto found = layer.vector()) return found;
    if (auto found = layer.luminance()) return found;
    return layer.onlyOne();
}

std::optional<ExrChannels> findLayer(const Imf::MultiPartInputFile& file, const std::string& layer) {
    for (int part = 0; part < file.parts(); ++part) {
        if (auto found = chooseOf(ExrLayer(file, part, layer + '.'))) return found;
        if (partName(file, part) == layer)
            if (auto found = chooseOf(ExrLayer(file, part, ""))) return found;
        if (file.header(part).channels().findChannel(layer) != nullptr) return ExrChannels{part, {layer}, Kind::Other};
    }
    return std::nullopt;
}

} // namespace

std::vector<std::string> exrLayers(const Imf::MultiPartInputFile& file) {
    std::vector<std::string> layers;
    const auto add = [&layers](const std::string& layer) {
        if (!layer.empty() && std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
    };
    for (int part = 0; part < file.parts(); ++part) {
        if (part > 0) add(partName(file, part));
        for (const std::string& channel : channelsOf(file.header(part)))
            if (const std::size_t dot = channel.rfind('.'); dot != std::string::npos) add(channel.substr(0, dot));
    }
    return layers;
}

ExrChannels chooseExrChannels(const Imf::MultiPartInputFile& file, const std::string& layer, const std::string& name) {
    const std::vector<std::string> layers = exrLayers(file);
    if (!layer.empty()) {
        if (auto found = findLayer(file, layer)) return *found;
        throw InputError(name + ": EXR file has no layer \"" + printable(layer, kMaxExrText) +
                         "\" that is a picture (" +
                         (layers.empty() ? "it has no layers" : "it has: " + listed(layers)) + ")");
    }
    const ExrLayer first(file, 0, "");
    if (auto found = first.color()) return *found;
    if (auto found = first.luminance()) return *found;
    for (const std::string& other : layers) {
        const auto found = findLayer(file, other);
        if (!found || found->kind == Kind::Other) continue;
        logWarning(name + ": of several layers the first is read, " + printable(other, kMaxExrText) +
                   " (it has: " + printable(listed(layers), kMaxExrText) + ")");
        return *found;
    }
    throw InputError(name + ": EXR file has neither channels R, G, B nor Y (it has: " +
                     listed(channelsOf(file.header(0))) + ")" + (layers.empty() ? "" : "; layers: " + listed(layers)));
}

} // namespace rt::image
