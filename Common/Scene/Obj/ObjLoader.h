// Wavefront OBJ files with their MTL materials.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Triangles of one material.
struct ObjPart {
    std::string material; // key of ObjModel::materials; empty: the file names none
    MeshData mesh;
    bool isUnlit = false; // it is as bright as its colour, and no light
};

struct ObjModel {
    std::vector<ObjPart> parts; // none is empty
    std::map<std::string, MaterialDesc> materials;
    std::map<std::string, TextureDesc> textures;
    std::vector<std::string> notices; // one line each: what is missing or left out
};

// What a surface without a material looks like.
MaterialDesc plainMaterial();

// Reads a file: polygons are cut into triangles, which are parted by material and by whether they have texture
// coordinates, normals and colours of vertices at every corner. Smoothing groups give normals where the file has none,
// and maps of normals tangents. What becomes of materials MtlMaterials.h says; names of materials and textures start
// with `prefix`, and are printable. What is missing, broken or left out is a notice. Without `withMaterials` the
// materials and colours of the file are ignored. Throws InputError where no face is left, for the first that is not,
// with file and line.
ObjModel loadObj(const std::filesystem::path& path, bool withMaterials, const std::string& prefix = {});

// A scene of the file alone, without other light than its own, seen whole from the front, slightly from the right and
// above.
SceneDesc loadObjScene(const std::filesystem::path& path);

} // namespace rt::scene
