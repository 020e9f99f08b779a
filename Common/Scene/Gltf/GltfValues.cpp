#include "Common/Scene/Gltf/GltfValues.h"

namespace rt::scene {

const tinygltf::Value* member(const tinygltf::Value& object, const char* key) {
    return object.IsObject() && object.Has(key) ? &object.Get(key) : nullptr;
}

double numberOf(const tinygltf::Value& object, const char* key, double usual) {
    const tinygltf::Value* value = member(object, key);
    return value && value->IsNumber() ? value->GetNumberAsDouble() : usual;
}

double component(const tinygltf::Value& object, const char* key, int index, double usual) {
    const tinygltf::Value* value = member(object, key);
    if (!value || !value->IsArray() || value->ArrayLen() <= static_cast<std::size_t>(index)) return usual;
    const tinygltf::Value& entry = value->Get(index);
    return entry.IsNumber() ? entry.GetNumberAsDouble() : usual;
}

glm::dvec3 vectorOf(const tinygltf::Value& object, const char* key, double usual) {
    return {component(object, key, 0, usual), component(object, key, 1, usual), component(object, key, 2, usual)};
}

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

} // namespace rt::scene
