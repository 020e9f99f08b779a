// Each scene of the menu has its small picture.
#include <filesystem>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"

namespace rt {
namespace {

TEST(ThumbnailFiles, ThereIsOneForEachScene) {
    const auto folder = std::filesystem::path(RT_SOURCE_DIR) / "Assets" / "thumbnails";
    for (const scene::BuiltinScene& scene : scene::builtinScenes()) {
        const auto file = folder / (std::string(scene.id) + ".png");
        ASSERT_TRUE(std::filesystem::exists(file)) << file << "; cmake --build build --target thumbnails";
        const image::Image image = image::readImage(file);
        EXPECT_EQ(image.width, 64u) << file;
        EXPECT_EQ(image.height, 64u) << file;
    }
}

} // namespace
} // namespace rt
