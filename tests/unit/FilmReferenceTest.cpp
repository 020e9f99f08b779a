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

    RenderSettings settings_;
    scene::CameraDesc camera_;
    FilmReference reference_;
};

TEST_F(FilmReferenceTest, FitsFilmsOfOneSceneCameraSizeAndDepth) {
    reference_.begin(7, camera_, settings_);
    EXPECT_FALSE(reference_.fits());
    EXPECT_FALSE(reference_.compare(image::Image(8, 8)));
    reference_.set(image::Image(8, 8));
    EXPECT_TRUE(reference_.fits());
    settings_.seed = 3;
    settings_.spp = 1;
    reference_.begin(7, camera_, settings_);
    EXPECT_TRUE(reference_.fits());
    reference_.begin(8, camera_, settings_);
    EXPECT_FALSE(reference_.fits());
    scene::CameraDesc moved = camera_;
    moved.lookFrom.x += 1;
    reference_.begin(7, moved, settings_);
    EXPECT_FALSE(reference_.fits());
    for (std::uint32_t RenderSettings::*const field :
         {&RenderSettings::width, &RenderSettings::height, &RenderSettings::maxDepth}) {
        RenderSettings other = settings_;
        ++(other.*field);
        reference_.begin(7, camera_, other);
        EXPECT_FALSE(reference_.fits());
    }
    reference_.begin(7, camera_, settings_);
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
    reference_.begin(7, camera_, settings_);
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
    reference_.begin(7, camera_, settings_);
    EXPECT_TRUE(reference_.curve().empty());
}

} // namespace
} // namespace rt::app
