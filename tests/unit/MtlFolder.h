// A fixture for tests of MTL files: a folder with a triangle and a material of its own.
#pragma once
#include <algorithm>
#include <fstream>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/TempFolder.h"

namespace rt::test {

inline const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";

class MtlFolder : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
    }
    scene::ObjModel load(const std::string& text) const {
        write("a.obj", text);
        return scene::loadObj(folder / "a.obj", true);
    }
    // Of a material file with these statements for one material, m.
    scene::MaterialDesc material(const std::string& statements) {
        write("a.mtl", "newmtl m\n" + statements);
        model = load("mtllib a.mtl\nusemtl m\n" + kTriangle);
        return model.materials.at("m");
    }
    const scene::ImageTexture& image(const std::string& name) const {
        return std::get<scene::ImageTexture>(model.textures.at(name));
    }
    std::string errorOf(const std::string& statements) {
        try {
            material(statements);
        } catch (const InputError& error) {
            const std::string message = error.what();
            return message.substr(message.find("a.mtl"));
        }
        return "no error";
    }
    bool notices(const std::string& text) const {
        return std::ranges::any_of(model.notices, [&](const std::string& n) { return n.find(text) != n.npos; });
    }

    TempFolder folder;
    scene::ObjModel model;
};

// Reflectance at normal incidence of the dielectric.
inline glm::dvec3 reflectance(const scene::PrincipledDesc& p) {
    const double amplitude = (p.ior - 1) / (p.ior + 1);
    return std::get<glm::dvec3>(p.specularColor) * (p.specular.factor * amplitude * amplitude);
}

} // namespace rt::test
