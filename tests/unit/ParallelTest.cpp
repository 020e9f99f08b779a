// Work on all threads: errors and the end of it are those of the thread that asked for it.
#include <atomic>
#include <string>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Parallel.h"
#include "Common/Scene/Compiler/SceneCompiler.h"

namespace rt {
namespace {

TEST(Parallel, OfSeveralErrorsTheOneOfTheLeastIndexIsThrown) {
    for (int run = 0; run < 200; ++run) {
        try {
            parallelFor(8, 100, [](std::size_t i) {
                if (i % 10 == 7) throw InputError(std::to_string(i));
            });
            FAIL();
        } catch (const InputError& error) {
            EXPECT_STREQ(error.what(), "7");
        }
    }
}

TEST(Parallel, WhoCallsTheCallerOffCallsOffAllThreads) {
    std::atomic<bool> callOff = false;
    std::atomic<std::size_t> begun = 0;
    const Interruptible interruptible(callOff);
    EXPECT_THROW(parallelFor(4, 1000,
                             [&](std::size_t) {
                                 if (++begun == 10) callOff = true;
                                 interruptionPoint();
                             }),
                 Interrupted);
    EXPECT_LT(begun, 20u);
    EXPECT_TRUE(interruptionRequested()) << "the caller's own flag is as it was";
}

// A scene of spheres, each of a material with a texture of its own.
scene::SceneDesc sceneOfImages(int count) {
    scene::SceneDesc desc;
    for (int i = 0; i < count; ++i) {
        const std::string name(1, static_cast<char>('a' + i));
        desc.textures[name] = scene::ImageTexture{RT_TEST_DATA_DIR "/images/gradient.jpg", {}};
        auto& image = std::get<scene::ImageTexture>(desc.textures[name]);
        image.image = static_cast<std::uint32_t>(i); // told apart by it alone
        desc.materials[name].albedo = name;
        desc.objects.push_back({scene::SphereDesc{{3.0 * i, 0, -9}, 1, {}, name}});
    }
    return desc;
}

TEST(Parallel, ImagesAreDecodedInTheOrderOfTheirUse) {
    scene::SceneDesc desc = sceneOfImages(20);
    desc.textures["unused"] = desc.textures["a"];
    std::get<scene::ImageTexture>(desc.textures["unused"]).image = 99;
    desc.materials["unused"].albedo = "unused";
    desc.textures["checks"] = scene::CheckerTexture{2, "b", "a"};
    desc.materials["checks"].albedo = "checks";
    std::get<scene::SphereDesc>(desc.objects[0].shape).material = "checks"; // b, then a
    scene::CompileOptions options;
    std::vector<std::uint32_t> opened;
    options.loadTexels = [&](const std::filesystem::path&, std::optional<std::uint32_t> image) {
        opened.push_back(*image); // on the caller's thread
        return scene::EncodedTexels(*image + 1, [width = *image + 1] {
            return scene::TexelData{width, 1, shared::kTexelSrgb8, std::vector<std::uint32_t>(width, width)};
        });
    };
    const auto compiled = scene::compileScene(desc, options);
    ASSERT_EQ(opened.size(), 20u) << "an image that nothing shows is not read";
    EXPECT_EQ(opened[0], 1u);
    EXPECT_EQ(opened[1], 0u);
    ASSERT_EQ(compiled->images.size(), 20u);
    std::size_t texels = 0;
    for (std::size_t i = 0; i < 20; ++i) {
        const shared::Image& image = compiled->images[i];
        EXPECT_EQ(image.width, opened[i] + 1);
        EXPECT_EQ(image.firstTexel, texels);
        EXPECT_EQ(compiled->texels[texels], opened[i] + 1);
        texels += image.width;
    }
    EXPECT_EQ(compiled->texels.size(), texels);

    options.loadTexels = [](const std::filesystem::path&, std::optional<std::uint32_t> image) {
        return scene::EncodedTexels(1, [number = *image]() -> scene::TexelData {
            if (number >= 3) throw InputError("image " + std::to_string(number) + " is damaged");
            return {1, 1, shared::kTexelSrgb8, {0}};
        });
    };
    for (int run = 0; run < 50; ++run) {
        try {
            scene::compileScene(desc, options);
            FAIL();
        } catch (const InputError& error) {
            EXPECT_STREQ(error.what(), "image 3 is damaged");
        }
    }
}

} // namespace
} // namespace rt
