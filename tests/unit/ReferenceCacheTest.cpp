// References that one program renders and another finds.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "Common/App/Session/ReferenceCache.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

class ReferenceCacheTest : public InteractiveFixture {
  protected:
    static ReferenceKey key(std::uint64_t hash) {
        ReferenceKey key;
        key.sceneHash = hash;
        key.width = key.height = 8;
        key.maxDepth = 50;
        return key;
    }
    static image::Film film() {
        image::Film film({8, 8, kReferenceReplicates, false});
        image::Film::TileBlock block;
        film.begin(0, 0, block);
        block.count = image::Film::kBlock;
        block.sum[0] = 3;
        film.commit(0, 0, block);
        return film;
    }
    static std::string bytesOf(const image::Film& film) {
        std::ostringstream out;
        film.writeState(out);
        return out.str();
    }
    static void setAge(const fs::path& file, int hours) {
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(hours));
    }
    InteractiveSession::Setup setupWithCache(std::uint32_t spp) const {
        InteractiveSession::Setup s = setup(spp);
        s.references = ReferenceCache(folder_ / "cache");
        return s;
    }

    ReferenceCache cache_{folder_ / "cache"};
};

TEST_F(ReferenceCacheTest, GivesBackTheFilmOfItsKeyAlone) {
    EXPECT_FALSE(cache_.has(key(1)));
    EXPECT_FALSE(cache_.load(key(1)));
    cache_.save(key(1), film());
    EXPECT_TRUE(cache_.has(key(1)));
    ASSERT_TRUE(cache_.load(key(1)));
    EXPECT_EQ(bytesOf(*cache_.load(key(1))), bytesOf(film()));
    EXPECT_FALSE(cache_.has(key(2)));
    ReferenceKey moved = key(1), deeper = key(1), wider = key(1);
    moved.camera.lookAt.y += 1;
    ++deeper.maxDepth;
    ++wider.width;
    for (const ReferenceKey& other : {moved, deeper, wider}) EXPECT_FALSE(cache_.has(other));
    const ReferenceCache none{{}};
    none.save(key(1), film());
    EXPECT_FALSE(none.has(key(1)));
}

TEST_F(ReferenceCacheTest, ADamagedOneIsAsNone) {
    cache_.save(key(1), film());
    std::ofstream(cache_.fileOf(key(1)), std::ios::binary | std::ios::in).write("damage", 6);
    EXPECT_FALSE(cache_.load(key(1)));
}

TEST_F(ReferenceCacheTest, ThoseThatWereUsedLeastRecentlyGo) {
    const ReferenceCache two(folder_ / "cache", 2 * bytesOf(film()).size());
    two.save(key(1), film());
    setAge(two.fileOf(key(1)), 3);
    two.save(key(2), film());
    setAge(two.fileOf(key(2)), 2);
    ASSERT_TRUE(two.load(key(1))); // is used now
    two.save(key(3), film());
    EXPECT_TRUE(two.has(key(1)));
    EXPECT_FALSE(two.has(key(2)));
    EXPECT_TRUE(two.has(key(3)));
    std::ofstream(folder_ / "cache" / "notes.txt") << std::string(100'000, ' '); // nothing of ours
    two.save(key(3), film());
    EXPECT_TRUE(fs::exists(folder_ / "cache" / "notes.txt"));
    EXPECT_TRUE(two.has(key(1)));
}

TEST_F(ReferenceCacheTest, WhatOneSessionRendersAnotherFindsAndGoesOnFrom) {
    {
        InteractiveSession first(setupWithCache(8));
        ASSERT_TRUE(reaches(first, isFinished));
        first.renderReference(64);
        ASSERT_TRUE(reaches(first, [](const SessionState& s) { return s.referenceFits && isFinished(s); }));
        EXPECT_EQ(first.state().reference, "rendered, 64 spp");
        EXPECT_GT(first.state().referenceError, 0);
        EXPECT_FALSE(first.state().curve.empty());
    }
    InteractiveSession second(setupWithCache(4));
    ASSERT_TRUE(reaches(second, isFinished));
    EXPECT_EQ(second.state().reference, "found, 64 spp");
    EXPECT_TRUE(second.state().referenceFits);
    EXPECT_FALSE(second.state().curve.empty()); // it is measured against it
    const int restored = SlowEngine::restored;
    second.renderReference(128);
    ASSERT_TRUE(reaches(second, [](const SessionState& s) { return s.reference == "rendered, 128 spp"; }));
    EXPECT_EQ(SlowEngine::restored - restored, 1);
    // Another size has none, and what there is does not fit it.
    RenderRequest request = setup(4).request;
    request.size.width = 32;
    second.change(request);
    ASSERT_TRUE(reaches(second, [](const SessionState& s) { return isFinished(s) && s.settings.width == 32; }));
    EXPECT_FALSE(second.state().referenceFits);
    request.size.width = 24;
    second.change(request);
    ASSERT_TRUE(reaches(second, [](const SessionState& s) { return isFinished(s) && s.settings.width == 24; }));
    EXPECT_TRUE(second.state().referenceFits);
}

} // namespace
} // namespace rt::app
