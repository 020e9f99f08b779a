// What a window's films are compared with.
#include <atomic>

#include <gtest/gtest.h>

#include "Common/App/Interactive/FilmReference.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {
namespace {

class FilmReferenceTest : public testing::Test {
  protected:
    FilmReferenceTest() { settings_.width = settings_.height = 8, settings_.spp = 40; }

    ReferenceKey key(std::uint64_t hash) const {
        return {hash, camera_, settings_.width, settings_.height, settings_.maxDepth};
    }

    RenderSettings settings_;
    scene::CameraDesc camera_;
    FilmReference reference_;
};

TEST_F(FilmReferenceTest, FitsFilmsOfOneSceneCameraSizeAndDepth) {
    reference_.begin(key(7));
    EXPECT_FALSE(reference_.fits());
    EXPECT_FALSE(reference_.compare(image::Image(8, 8)));
    reference_.set(image::Image(8, 8));
    EXPECT_TRUE(reference_.fits());
    settings_.seed = 3;
    settings_.spp = 1;
    reference_.begin(key(7));
    EXPECT_TRUE(reference_.fits());
    reference_.begin(key(8));
    EXPECT_FALSE(reference_.fits());
    ReferenceKey moved = key(7);
    moved.camera.lookFrom.x += 1;
    reference_.begin(moved);
    EXPECT_FALSE(reference_.fits());
    for (const auto field : {&ReferenceKey::width, &ReferenceKey::height, &ReferenceKey::maxDepth}) {
        ReferenceKey other = key(7);
        ++(other.*field);
        reference_.begin(other);
        EXPECT_FALSE(reference_.fits());
    }
    reference_.begin(key(7));
    EXPECT_TRUE(reference_.fits());
    reference_.render(100); // a film that will be the reference is not compared
    EXPECT_FALSE(reference_.fits());
    reference_.giveUp();
    EXPECT_TRUE(reference_.fits()); // the one before stays
}

TEST_F(FilmReferenceTest, TheCurveFollowsTheFilmAtTimesThatGrowByATenth) {
    FakeEngine engine;
    FilmRun film(engine, camera_, settings_);
    const std::atomic<bool> goOn{false};
    reference_.begin(key(7));
    film.slice(1, goOn);
    reference_.follow(film, engine.film().resolve());
    EXPECT_TRUE(reference_.curve().empty()); // nothing to compare with
    reference_.set(image::Image(8, 8));
    do reference_.follow(film, engine.film().resolve());
    while (!film.slice(1, goOn));
    reference_.follow(film, engine.film().resolve());
    const std::vector<ErrorPoint>& curve = reference_.curve();
    ASSERT_GE(curve.size(), 2u);
    for (std::size_t i = 1; i + 1 < curve.size(); ++i) EXPECT_GE(curve[i].seconds, 1.1 * curve[i - 1].seconds);
    EXPECT_EQ(curve.back().spp, 40);
    EXPECT_EQ(curve.back().relmse, image::compare(engine.film().resolve(), image::Image(8, 8)).relmse);
    reference_.begin(key(7));
    EXPECT_TRUE(reference_.curve().empty());
}

} // namespace
} // namespace rt::app
