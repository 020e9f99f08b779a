#include "Common/Scene/Json/JsonNode.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "Common/Core/Error.h"

namespace rt::scene {

namespace {

using Json = nlohmann::json;

// What a message quotes of a value.
std::string excerpt(const Json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return "an array of " + std::to_string(value.size());
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

std::string alternatives(std::span<const char* const> names) {
    std::string text;
    for (const char* name : names) text.append(text.empty() ? "" : ", ").append(name);
    return text;
}

std::string rangeText(double low, double high) {
    std::ostringstream text;
    text << "from " << low << " to " << high;
    return text.str();
}

} // namespace

std::string JsonNode::path() const {
    if (!parent_) return "";
    return parent_->path() + "/" + (key_ ? std::string(key_) : std::to_string(index_));
}

void JsonNode::fail(const std::string& message) const {
    const std::string place = path();
    throw InputError(*file_ + ": " + (place.empty() ? "/" : place) + ": " + message);
}

void JsonNode::failValue(const std::string& expected) const {
    fail(excerpt(*value_) + ": must be " + expected);
}

void JsonNode::expectKeys(std::span<const char* const> allowed) const {
    if (!value_->is_object()) failValue("an object with " + alternatives(allowed));
    for (const auto& member : value_->items()) {
        const auto matches = [&](const char* name) { return member.key() == name; };
        if (std::none_of(allowed.begin(), allowed.end(), matches))
            fail("unknown key " + excerpt(member.key()) + "; allowed: " + alternatives(allowed));
    }
}

JsonNode JsonNode::at(const char* key) const {
    if (!value_->is_object()) failValue("an object with " + excerpt(key));
    const auto found = value_->find(key);
    if (found == value_->end()) fail(excerpt(key) + " is missing");
    return JsonNode(*found, *this, key, 0);
}

std::optional<JsonNode> JsonNode::find(const char* key) const {
    if (!has(key)) return std::nullopt;
    return at(key);
}

std::size_t JsonNode::arraySize() const {
    if (!value_->is_array()) failValue("an array");
    return value_->size();
}

JsonNode JsonNode::element(std::size_t index) const {
    return JsonNode((*value_)[index], *this, nullptr, index);
}

bool JsonNode::boolean() const {
    if (!value_->is_boolean()) failValue("true or false");
    return value_->get<bool>();
}

std::string JsonNode::string() const {
    if (!value_->is_string()) failValue("a string");
    return value_->get<std::string>();
}

std::string JsonNode::oneOf(std::initializer_list<const char*> allowed) const {
    std::string text = value_->is_string() ? value_->get<std::string>() : std::string();
    if (std::none_of(allowed.begin(), allowed.end(), [&](const char* name) { return text == name; }))
        failValue("one of " + alternatives({allowed.begin(), allowed.size()}));
    return text;
}

double JsonNode::number() const {
    return within(-kLargest, kLargest);
}

double JsonNode::positive() const {
    return within(1 / kLargest, kLargest);
}

double JsonNode::within(double low, double high) const {
    if (!value_->is_number() || !(value_->get<double>() >= low && value_->get<double>() <= high))
        failValue("a number " + rangeText(low, high));
    return value_->get<double>();
}

std::uint32_t JsonNode::unsignedInteger() const {
    if (!value_->is_number_unsigned() || value_->get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
        failValue("a whole number from 0 to 4294967295");
    return value_->get<std::uint32_t>();
}

glm::dvec3 JsonNode::vectorWithin(double low, double high) const {
    if (!value_->is_array() || value_->size() != 3) failValue("an array of 3 numbers " + rangeText(low, high));
    glm::dvec3 v;
    for (int i = 0; i < 3; ++i) v[i] = element(static_cast<std::size_t>(i)).within(low, high);
    return v;
}

std::vector<double> JsonNode::numbers(std::size_t width) const {
    std::vector<double> numbers(arraySize());
    if (numbers.empty() || numbers.size() % width != 0)
        failValue("an array whose length is a multiple of " + std::to_string(width) + " and not 0");
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = element(i).number();
    return numbers;
}

} // namespace rt::scene
