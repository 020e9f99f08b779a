// A fixture for tests of OBJ files: a folder of its own.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/TempFolder.h"

namespace rt::test {

inline const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class ObjFolder : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    scene::ObjModel load(const std::string& text, bool withMaterials = true) const {
        return scene::loadObj(write("model.obj", text), withMaterials);
    }
    std::string errorOf(const std::string& text, bool withMaterials = true) const {
        try {
            load(text, withMaterials);
        } catch (const InputError& error) {
            const std::string message = error.what();
            const std::size_t start = message.find("model.");
            return start == std::string::npos ? message : message.substr(start);
        }
        return "no error";
    }

    static bool hasNotice(const scene::ObjModel& model, const std::string& text) {
        return std::ranges::any_of(model.notices, [&](const std::string& n) { return n.find(text) != n.npos; });
    }

    TempFolder folder_;
};

} // namespace rt::test
