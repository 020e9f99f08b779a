#include "Common/Scene/MaterialX/MaterialXGraph.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/OtherCase.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/MaterialX/MaterialXValues.h"

namespace rt::scene {

namespace {

constexpr int kMaxFollowed = 1000; // nodes for one input
constexpr int kMaxChain = 64;      // one behind the other

} // namespace

MaterialXGraph::MaterialXGraph(const XmlElement& root, const std::string& file, const std::filesystem::path& folder,
                               std::set<std::string>& notices)
    : root_(root), file_(file), folder_(folder), notices_(notices) {
    const auto addNames = [this](const XmlElement& scope) {
        Names& names = names_[&scope];
        for (const XmlElement& node : scope.children)
            if (const std::string* name = node.find("name"); name != nullptr && node.name != "input")
                names.emplace(*name, &node);
    };
    addNames(root_);
    for (const XmlElement& node : root_.children)
        if (node.name == "nodegraph") addNames(node);
}

void MaterialXGraph::fail(const XmlElement& element, const std::string& message) const {
    throw InputError(file_ + ":" + std::to_string(element.line) + ": " + materialXPlace(element) + ": " + message);
}

void MaterialXGraph::leaveOut(const XmlElement& node, const std::string& what) {
    notices_.insert(materialXPlace(node) + ": " + what);
}

const XmlElement* MaterialXGraph::find(const XmlElement& scope, const std::string& name) const {
    const Names& names = names_.at(&scope);
    const auto found = names.find(name);
    return found != names.end() ? found->second : nullptr;
}

const XmlElement& MaterialXGraph::findOrFail(const XmlElement& scope, const std::string& name,
                                             const XmlElement& asker) const {
    const XmlElement* found = find(scope, name);
    if (found == nullptr) fail(asker, "\"" + printable(name, 100) + "\": must be the name of a node beside it");
    return *found;
}

const XmlElement* MaterialXGraph::source(const XmlElement& input) const {
    const std::string* name = input.find("nodename");
    return name != nullptr ? &findOrFail(root_, *name, input) : nullptr;
}

bool MaterialXGraph::flag(const XmlElement& node, const XmlElement& input) const {
    const std::string* value = input.find("value");
    if (value == nullptr || (*value != "true" && *value != "false" && *value != "1" && *value != "0"))
        fail(node, "input " + input.attribute("name") + ": must have a value, true or false");
    return *value == "true" || *value == "1";
}

std::optional<MaterialXSignal> MaterialXGraph::signal(const XmlElement& node, const XmlElement& input) {
    depth_ = steps_ = 0;
    return follow({&root_, nullptr}, node, input);
}

std::optional<MaterialXSignal> MaterialXGraph::follow(const Scope& scope, const XmlElement& of,
                                                      const XmlElement& input) {
    if (++steps_ > kMaxFollowed) fail(of, "more than 1000 nodes lead to one input");
    if (++depth_ > kMaxChain) fail(of, "nodes lead round in a circle, or more than 64 are one behind the other");
    std::optional<MaterialXSignal> result;
    const std::string output = input.attribute("output");
    if (const std::string* graph = input.find("nodegraph")) {
        const XmlElement& nodes = findOrFail(root_, *graph, of);
        if (nodes.name != "nodegraph") fail(of, "\"" + printable(*graph, 100) + "\": must be the name of a nodegraph");
        const XmlElement* end = nullptr; // the output of that name, or the only one
        for (const XmlElement& each : nodes.children)
            if (each.name == "output" && (output.empty() || each.attribute("name") == output)) end = &each;
        if (end == nullptr) fail(of, "nodegraph \"" + printable(*graph, 100) + "\" has no output \"" + output + "\"");
        result = follow({&nodes, &nodes}, nodes, *end);
    } else if (const std::string* name = input.find("nodename")) {
        result = node(scope, findOrFail(*scope.nodes, *name, of), output);
    } else if (const std::string* outer = input.find("interfacename"); outer != nullptr && scope.outer != nullptr) {
        const XmlElement* given = scope.outer->child("input", *outer);
        if (given == nullptr) fail(of, "\"" + printable(*outer, 100) + "\": must be the name of an input of the graph");
        result = follow({&root_, nullptr}, *scope.outer, *given);
    } else {
        result = MaterialXSignal{constant(scope, of, input), {}, {}, {}, false, false};
    }
    --depth_;
    return input.find("channels") != nullptr && result ? swizzled(of, *result, input.attribute("channels")) : result;
}

// Of version 1.38: an input that takes one channel of what comes.
std::optional<MaterialXSignal> MaterialXGraph::swizzled(const XmlElement& of, const MaterialXSignal& signal,
                                                        const std::string& channels) {
    constexpr std::string_view kColors = "rgba", kAxes = "xyzw";
    if (kColors.starts_with(channels) && channels.size() > 1) return signal;
    if (kAxes.starts_with(channels) && channels.size() > 1) return signal;
    const std::size_t color = channels.size() == 1 ? kColors.find(channels) : kColors.npos;
    const std::size_t axis = channels.size() == 1 ? kAxes.find(channels) : kAxes.npos;
    if (color == kColors.npos && axis == kAxes.npos) {
        leaveOut(of, "left out: its channels \"" + printable(channels, 100) + "\" are none or change places");
        return std::nullopt;
    }
    return channelOf(of, signal, std::min(color, axis));
}

// What comes out of a node.
std::optional<MaterialXSignal> MaterialXGraph::node(const Scope& scope, const XmlElement& of,
                                                    const std::string& output) {
    if (of.name == "image" || of.name == "tiledimage") return imageOf(scope, of);
    if (of.name == "constant") return inner(scope, of, "value");
    if (of.name == "output") return follow(scope, of, of);
    if (of.name == "dot" || of.name == "convert") return inner(scope, of, "in");
    if (of.name == "multiply") return product(scope, of);
    if (of.name == "invert") return inverse(scope, of);
    if (of.name == "normalmap") return normalMap(scope, of);
    if (of.name == "extract") {
        const glm::dvec4 index = constantOr(scope, of, "index", glm::dvec4(0));
        if (!(index.x >= 0 && index.x <= 3)) fail(of, "input index: must be from 0 to 3");
        return channelOfInner(scope, of, static_cast<std::size_t>(index.x));
    }
    if (of.name.starts_with("separate")) {
        constexpr std::string_view kOutputs[] = {"outr", "outx", "outg", "outy", "outb", "outz", "outa", "outw"};
        const auto* const found = std::find(std::begin(kOutputs), std::end(kOutputs), output);
        if (found == std::end(kOutputs)) fail(of, "has no output \"" + printable(output, 100) + "\"");
        return channelOfInner(scope, of, static_cast<std::size_t>(found - std::begin(kOutputs)) / 2);
    }
    leaveOut(of, "left out: only constants and images are read, with multiply, invert, extract and normalmap");
    return std::nullopt;
}

std::optional<MaterialXSignal> MaterialXGraph::inner(const Scope& scope, const XmlElement& of, const char* name) {
    const XmlElement* input = of.child("input", name);
    if (input == nullptr) fail(of, std::string("must have an input ") + name);
    return follow(scope, of, *input);
}

MaterialXSignal MaterialXGraph::channelOf(const XmlElement& of, MaterialXSignal signal, std::size_t channel) const {
    const auto index = static_cast<glm::length_t>(channel);
    if (signal.image && signal.channel) {
        if (channel > 0) fail(of, "takes a channel of what has only one");
        return signal;
    }
    signal.factor = glm::dvec4(signal.factor[index]);
    if (signal.image) signal.channel = static_cast<Channel>(channel);
    return signal;
}

std::optional<MaterialXSignal> MaterialXGraph::channelOfInner(const Scope& scope, const XmlElement& of,
                                                              std::size_t channel) {
    const std::optional<MaterialXSignal> signal = inner(scope, of, "in");
    return signal ? std::optional(channelOf(of, *signal, channel)) : std::nullopt;
}

std::optional<MaterialXSignal> MaterialXGraph::product(const Scope& scope, const XmlElement& of) {
    std::optional<MaterialXSignal> a = inner(scope, of, "in1"), b = inner(scope, of, "in2");
    if (!a || !b) return std::nullopt;
    if (b->image) std::swap(a, b);
    if (b->image || a->isInverted) {
        leaveOut(of, "left out: only an image times a constant is read");
        return std::nullopt;
    }
    a->factor *= b->factor;
    return a;
}

std::optional<MaterialXSignal> MaterialXGraph::inverse(const Scope& scope, const XmlElement& of) {
    std::optional<MaterialXSignal> signal = inner(scope, of, "in");
    const glm::dvec4 amount = constantOr(scope, of, "amount", glm::dvec4(1));
    if (!signal) return signal;
    if (!signal->image) {
        signal->factor = amount - signal->factor;
        return signal;
    }
    if (amount != glm::dvec4(1)) leaveOut(of, "its amount is left out: it is 1");
    signal->isInverted = !signal->isInverted;
    return signal;
}

// The strength is where the factor of the image was.
std::optional<MaterialXSignal> MaterialXGraph::normalMap(const Scope& scope, const XmlElement& of) {
    std::optional<MaterialXSignal> signal = inner(scope, of, "in");
    if (!signal) return signal;
    signal->isNormalMap = true;
    signal->factor = constantOr(scope, of, "scale", glm::dvec4(1));
    return signal;
}

glm::dvec4 MaterialXGraph::constantOr(const Scope& scope, const XmlElement& of, const char* name,
                                      const glm::dvec4& usual) {
    const XmlElement* input = of.child("input", name);
    if (input == nullptr) return usual;
    const std::optional<MaterialXSignal> signal = follow(scope, of, *input);
    if (!signal) return usual;
    if (!signal->image) return signal->factor;
    leaveOut(of, std::string("the image at its input ") + name + " is left out");
    return usual;
}

glm::dvec4 MaterialXGraph::constant(const Scope& scope, const XmlElement& of, const XmlElement& input) const {
    const std::string* text = input.find("value");
    const std::string name = input.name == "input" ? "input " + input.attribute("name") : input.name;
    if (text == nullptr) fail(of, name + ": must have a value, or name a node");
    const auto value = materialXValue(*text, input.attribute("type"));
    if (!value)
        fail(of,
             name + ": \"" + printable(*text, 100) + "\": must be " + materialXExpectation(input.attribute("type")));
    const bool isColor = input.attribute("type").starts_with("color");
    return isColor && isSrgb(inherited(scope, of, &input, "colorspace")) ? decodedSrgb(*value) : *value;
}

// The nearest of the elements around that say it.
std::string MaterialXGraph::inherited(const Scope& scope, const XmlElement& of, const XmlElement* input,
                                      const char* attribute) const {
    for (const XmlElement* element : {input, &of, scope.nodes, &root_})
        if (element != nullptr)
            if (const std::string* found = element->find(attribute)) return *found;
    return {};
}

// ---- images --------------------------------------------------------------------------------------------------------

std::optional<MaterialXSignal> MaterialXGraph::imageOf(const Scope& scope, const XmlElement& of) {
    const XmlElement* input = of.child("input", "file");
    if (input != nullptr && input->find("interfacename") != nullptr && scope.outer != nullptr)
        input = scope.outer->child("input", input->attribute("interfacename"));
    const std::string* file = input != nullptr ? input->find("value") : nullptr;
    if (file == nullptr || file->empty()) fail(of, "must have an input file with a value");
    if (file->find('<') != file->npos || file->find('{') != file->npos) {
        leaveOut(of, "left out: \"" + printable(*file, 100) + "\" is the name of many images");
        return std::nullopt;
    }
    const std::filesystem::path beside = folder_ / (inherited(scope, of, nullptr, "fileprefix") + *file);
    const std::filesystem::path path = std::filesystem::absolute(beside).lexically_normal();
    std::error_code none;
    if (mayRead(path) && !std::filesystem::exists(path, none) && findInOtherCase(path).empty()) {
        leaveOut(of, "left out: there is no image \"" + printable(*file, 200) + "\"");
        return std::nullopt;
    }
    MaterialXSignal signal;
    signal.imageNode = of.attribute("name");
    ImageTexture& image = signal.image.emplace();
    image.file = path.generic_string();
    image.standIn = kWhiteStandIn;
    const std::string space = inherited(scope, of, input, "colorspace");
    const bool isColor = of.attribute("type").starts_with("color");
    image.colorSpace = isColor && isSrgb(space) ? ColorSpace::Srgb : ColorSpace::Linear;
    if (isColor && !isSrgb(space) && !isLinear(space))
        leaveOut(of, "the colour space " + printable(space, 100) + " is read as linear Rec. 709");
    placeImage(scope, of, image);
    if (of.attribute("type") == "float") signal.channel = Channel::Red;
    return signal;
}

void MaterialXGraph::placeImage(const Scope& scope, const XmlElement& of, ImageTexture& image) {
    const auto wrap = [&](const char* name) {
        const XmlElement* input = of.child("input", name);
        const std::string mode = input != nullptr ? input->attribute("value") : "periodic";
        if (mode == "mirror") return Wrap::Mirror;
        if (mode == "constant") leaveOut(of, "beyond the image its edges go on, not the default");
        if (mode != "periodic" && mode != "clamp" && mode != "constant")
            fail(of, std::string("input ") + name + ": \"" + printable(mode, 100) +
                         "\": must be periodic, clamp, mirror or constant");
        return mode == "periodic" ? Wrap::Repeat : Wrap::Clamp;
    };
    image.wrapU = wrap("uaddressmode");
    image.wrapV = wrap("vaddressmode");
    const glm::dvec4 tiling = constantOr(scope, of, "uvtiling", glm::dvec4(1));
    const glm::dvec4 offset = constantOr(scope, of, "uvoffset", glm::dvec4(0));
    image.uvTransform = {tiling.x, 0, -offset.x, 0, tiling.y, -offset.y};
    for (const double entry : image.uvTransform)
        if (!(std::abs(entry) <= kLargest)) fail(of, "uvtiling and uvoffset must be from -1e9 to 1e9");
    const XmlElement* place = of.child("input", "texcoord");
    const std::string* name = place != nullptr ? place->find("nodename") : nullptr;
    if (name == nullptr) return;
    const XmlElement& coordinates = findOrFail(*scope.nodes, *name, of);
    if (coordinates.name != "texcoord")
        return leaveOut(coordinates, "left out: images lie where texture coordinates say");
    const glm::dvec4 set = constantOr(scope, coordinates, "index", glm::dvec4(0));
    if (set.x == 0 || set.x == 1)
        image.uvSet = static_cast<std::uint32_t>(set.x);
    else
        leaveOut(coordinates, "coordinates beyond the second set are read as the first");
}

} // namespace rt::scene
