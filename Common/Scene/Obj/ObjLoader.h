// Wavefront OBJ files with their MTL materials.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// The triangles of one material.
struct ObjPart {
    std::string material; // key of ObjModel::materials; empty: the file names none
    MeshData mesh;
};

struct ObjModel {
    std::vector<ObjPart> parts; // none is empty
    std::map<std::string, MaterialDesc> materials;
    std::map<std::string, TextureDesc> textures;
    std::vector<std::string> notices; // one line each: what is missing or left out
};

// What a surface without a material looks like.
MaterialDesc plainMaterial();

// Reads a file: polygons are cut into triangles; normals, texture coordinates and colours of vertices kept where every
// corner of a part has them, tangents computed where a map of normals needs them. What becomes of materials
// MtlMaterials.h says; names of materials and textures start with `prefix`, and are printable. A material file or an
// image that does not exist, or a material that is in no file, is a notice. Without `withMaterials` the materials and
// colours of the file are ignored and there is one part. Throws InputError with file and line.
ObjModel loadObj(const std::filesystem::path& path, bool withMaterials, const std::string& prefix = {});

// A scene of the file alone, under a gradient sky, seen whole from the front, slightly from the right and above.
SceneDesc loadObjScene(const std::filesystem::path& path);

} // namespace rt::scene
