// Whose turn it is in a race, who leads, and what is kept of it.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/Race.h"
#include "Common/App/Interactive/RaceFiles.h"
#include "Common/Bench/Suite.h"
#include "Common/Render/Names.h"
#include "tests/unit/JsonSchema.h"

namespace rt::app {
namespace {

RaceEntrant entrantWith(LightSampling estimator, SamplerKind sampler = SamplerKind::Sobol, bool isDenoised = false) {
    RaceEntrant entrant;
    entrant.settings.lightSampling = estimator;
    entrant.settings.sampler = sampler;
    entrant.isDenoised = isDenoised;
    return entrant;
}

RaceRequest twoEntrants(double seconds = 4) {
    return {{entrantWith(LightSampling::Mis), entrantWith(LightSampling::Bsdf)}, seconds};
}

// error = scale / seconds, at seconds that double.
std::vector<ErrorPoint> curveOf(double scale, double first, double last) {
    std::vector<ErrorPoint> curve;
    for (double seconds = first; seconds <= last; seconds *= 2)
        curve.push_back({seconds, 10 * seconds, scale / seconds});
    return curve;
}

std::vector<RaceLane> raceLanesOf(const std::vector<std::vector<ErrorPoint>>& curves) {
    std::vector<RaceLane> lanes;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        lanes.emplace_back();
        lanes.back().name = std::string(1, static_cast<char>('A' + i));
        lanes.back().curve = curves[i];
    }
    return lanes;
}

TEST(ErrorCurve, BetweenPointsAreStraightLinesOnLogarithmicAxes) {
    const std::vector<ErrorPoint> curve{{1, 1, 0.1}, {4, 4, 0.025}, {16, 16, 0.025}};
    EXPECT_NEAR(*errorAt(curve, 2), 0.05, 1e-12);
    EXPECT_EQ(*errorAt(curve, 1), 0.1);
    EXPECT_EQ(*errorAt(curve, 16), 0.025);
    EXPECT_FALSE(errorAt(curve, 0.99));
    EXPECT_FALSE(errorAt(curve, 16.1));
    EXPECT_NEAR(*secondsTo(curve, 0.05), 2, 1e-12);
    EXPECT_FALSE(secondsTo(curve, 0.02));
    EXPECT_FALSE(secondsTo(curve, 0.2)); // it was below before its first point
    EXPECT_FALSE(errorAt({}, 1));
    EXPECT_FALSE(secondsTo({}, 1));
}

// A firefly raises the error again: what counts is when it has come down for good.
TEST(ErrorCurve, AnErrorIsReachedWhenItStaysSo) {
    const std::vector<ErrorPoint> curve{{1, 1, 0.4}, {2, 2, 0.1}, {4, 4, 0.4}, {8, 8, 0.1}};
    EXPECT_NEAR(*secondsTo(curve, 0.2), 4 * std::sqrt(2.0), 1e-9);
}

TEST(Race, TheTurnIsThatOfWhoHasHadLeast) {
    Race race(twoEntrants(), false);
    EXPECT_EQ(race.next(), 0u);
    race.spend(0, 0.5);
    EXPECT_EQ(race.next(), 1u);
    race.spend(1, 0.4);
    EXPECT_EQ(race.next(), 1u); // it is still behind
    race.spend(1, 4.1);
    EXPECT_EQ(race.secondsLeft(1), 0);
    EXPECT_EQ(race.next(), 0u);
    race.spend(0, 4);
    EXPECT_FALSE(race.next());
    EXPECT_FALSE(race.isOver()); // their last pictures have not been looked at
    race.look(0, ErrorPoint{4, 1, 1});
    race.look(1, ErrorPoint{4, 1, 1});
    EXPECT_TRUE(race.isOver());
}

TEST(Race, TheOtherProgramHasNoTurns) {
    RaceRequest request = twoEntrants();
    request.entrants[0].isOther = true;
    Race race(request, false);
    EXPECT_EQ(race.next(), 1u);
    race.spend(1, 4);
    race.look(1, std::nullopt);
    EXPECT_FALSE(race.next());
    EXPECT_FALSE(race.isOver());
    race.finish(0);
    EXPECT_TRUE(race.isOver());
}

TEST(Race, PicturesAreLookedAtWhenThereIsMoreToSee) {
    RaceRequest request = twoEntrants(10);
    request.entrants[1].isDenoised = true;
    Race race(request, false);
    EXPECT_FALSE(race.isLookDue(0));
    for (const std::size_t i : {0u, 1u}) {
        race.spend(i, 1);
        EXPECT_TRUE(race.isLookDue(i));
        race.look(i, std::nullopt);
        EXPECT_FALSE(race.isLookDue(i));
        race.spend(i, 1.3);
    }
    EXPECT_TRUE(race.isLookDue(0));
    EXPECT_FALSE(race.isLookDue(1)); // each of its looks costs a filter
    race.spend(0, 9.9);
    race.look(0, ErrorPoint{9.9, 1, 1});
    race.spend(0, 10); // the last picture counts
    EXPECT_TRUE(race.isLookDue(0));
}

TEST(Race, WhoHasNoPictureInTimeIsTold) {
    Race race(twoEntrants(), false);
    race.spend(0, 4);
    race.look(0, std::nullopt);
    EXPECT_EQ(race.lanes()[0].trouble, "no whole picture within its 4 s");
    race.drop(1, "the device was lost");
    EXPECT_EQ(race.lanes()[1].trouble, "the device was lost");
    EXPECT_TRUE(race.isOver());
    EXPECT_FALSE(standingOf(race.lanes()));
}

TEST(Race, EntrantsAreNamedByWhatDiffers) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(namesOf(twoEntrants().entrants, false), (Names{"MIS (power heuristic)", "Off (BSDF only)"}));
    std::vector<RaceEntrant> entrants{entrantWith(LightSampling::Mis, SamplerKind::Independent, true),
                                      entrantWith(LightSampling::Mis)};
    EXPECT_EQ(namesOf(entrants, false), (Names{"Independent (random), denoised", "Sobol (Owen-scrambled)"}));
    entrants[0] = entrants[1];
    EXPECT_EQ(namesOf(entrants, false), (Names{"Entrant 1", "Entrant 2"}));
    entrants[1].isOther = true;
    EXPECT_EQ(namesOf(entrants, false), (Names{"CPU", "GPU"}));
    EXPECT_EQ(namesOf(entrants, true), (Names{"GPU", "CPU"}));
    entrants[0].settings.specularConnections = false; // whose words tell nothing by themselves
    EXPECT_EQ(namesOf(entrants, false), (Names{"CPU, Glass connections Off", "GPU, Glass connections On"}));
}

TEST(RaceStanding, ComparesTheTimeToTheSameError) {
    const auto lanes = raceLanesOf({curveOf(4, 1, 64), curveOf(1, 1, 64), curveOf(8, 1, 32)});
    const auto standing = standingOf(lanes);
    ASSERT_TRUE(standing);
    EXPECT_EQ(standing->leader, 1u);
    EXPECT_EQ(standing->second, 0u);
    EXPECT_EQ(standing->seconds, 32); // that all have had
    EXPECT_TRUE(standing->isByTime);
    EXPECT_NEAR(standing->factor, 4, 1e-9);
    EXPECT_NEAR(*factorOf(lanes, *standing, 2), 8, 1e-9);
    EXPECT_EQ(*factorOf(lanes, *standing, 1), 1);
    EXPECT_EQ(headlineOf(lanes, *standing), "B leads: same error in 1/4 of the time of A");
}

// Where the leader began below all that the other has reached there is no such time.
TEST(RaceStanding, ComparesErrorsWhereTheyHaveNoneInCommon) {
    const auto lanes = raceLanesOf({curveOf(1, 1, 8), curveOf(100, 1, 8)});
    const auto standing = standingOf(lanes);
    ASSERT_TRUE(standing);
    EXPECT_FALSE(standing->isByTime);
    EXPECT_NEAR(standing->factor, 100, 1e-9);
    EXPECT_EQ(headlineOf(lanes, *standing), "A leads: error \u00d7 time 1/100 of that of B");
}

// As of an entrant whose filter takes longer than the others race.
TEST(RaceStanding, ComparesErrorTimesTimeWhereOneBeginsLater) {
    const auto lanes = raceLanesOf({curveOf(1, 1, 2), curveOf(0.25, 4, 8)});
    const auto standing = standingOf(lanes);
    ASSERT_TRUE(standing);
    EXPECT_EQ(standing->leader, 1u);
    EXPECT_FALSE(standing->isByTime);
    EXPECT_NEAR(standing->factor, 4, 1e-9);
}

TEST(RaceStanding, TellsWhenNobodyLeads) {
    const auto lanes = raceLanesOf({curveOf(1, 1, 8), curveOf(1.02, 1, 8)});
    EXPECT_EQ(headlineOf(lanes, *standingOf(lanes)), "A and B are level after 8 s");
    EXPECT_FALSE(standingOf(raceLanesOf({curveOf(1, 1, 8), {}})));
    EXPECT_FALSE(standingOf({}));
}

RaceState raceOf(std::vector<RaceEntrant> entrants) {
    RaceState state;
    Race race({std::move(entrants), 8}, false);
    state.lanes = race.lanes();
    state.seconds = 8;
    for (std::size_t i = 0; i < state.lanes.size(); ++i) {
        state.lanes[i].curve = curveOf(1.0 + static_cast<double>(i), 1, 8);
        state.lanes[i].engine = "multi";
        state.lanes[i].device = "A \"quick\" one, of two";
    }
    state.work.request.source = "veach-mis";
    state.work.title = "Veach MIS";
    state.work.camera.lookFrom = {1.0 / 3, 2, -7};
    state.work.camera.defocusAngle = 0.25;
    state.work.settings.width = 64;
    state.work.settings.height = 48;
    state.work.settings.maxDepth = 7;
    state.work.settings.russianRoulette = false;
    return state;
}

TEST(RaceFiles, TheTableHasALineForEachPoint) {
    const std::string table = raceTable(raceOf(twoEntrants().entrants), false);
    std::istringstream lines(table);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line.find("entrant,program,engine,device,denoised,light_sampling,"), 0u) << line;
    const auto commas = std::count(line.begin(), line.end(), ',');
    std::vector<std::string> rows;
    while (std::getline(lines, line)) rows.push_back(line);
    ASSERT_EQ(rows.size(), 8u) << table;
    EXPECT_EQ(rows[0].find("MIS (power heuristic),cpu,multi,\"A \"\"quick\"\" one, of two\",off,mis,"), 0u) << rows[0];
    EXPECT_EQ(std::count(rows[0].begin(), rows[0].end(), ','), commas + 1); // one is in the device's name
    EXPECT_NE(rows[7].find(",8,80,0.25,"), std::string::npos) << rows[7];
    EXPECT_NEAR(std::stod(rows[7].substr(rows[7].rfind(',') + 1)), 2, 1e-9); // times the leader's time
    EXPECT_EQ(rows[6].back(), ',');                                          // which the last point alone has
}

TEST(RaceFiles, TheSuiteRepeatsTheEntrants) {
    const std::vector<RaceEntrant> entrants{entrantWith(LightSampling::Mis, SamplerKind::Stratified),
                                            entrantWith(LightSampling::Bsdf, SamplerKind::Sobol, true),
                                            entrantWith(LightSampling::Mixture)};
    RaceState state = raceOf(entrants);
    state.lanes[2].entrant.isOther = true;
    state.lanes[2].engine = "query";
    state.work.threads = 1;
    EXPECT_EQ(whyNoSuite(state), nullptr);
    const std::string text = raceSuite(state, false);
    std::ifstream in(RT_SOURCE_DIR "/Assets/bench.schema.json");
    const nlohmann::json schema = nlohmann::json::parse(in);
    EXPECT_TRUE(test::JsonSchema(schema).accepts(nlohmann::json::parse(text))) << text;
    const bench::Suite suite = bench::parseSuite(text, "race.json");
    ASSERT_EQ(suite.experiments.size(), 1u);
    EXPECT_EQ(suite.referenceSeconds, kReferenceShare * 8);
    EXPECT_EQ(suite.experiments[0].seconds, (std::vector<double>{0.5, 1, 2, 4, 8}));
    const std::vector<bench::Config> configs = bench::combinations(suite.experiments[0], 4);
    ASSERT_EQ(configs.size(), 3u);
    for (std::size_t i = 0; i < configs.size(); ++i) {
        const bench::Config& config = configs[i];
        RenderSettings wanted = entrants[i].settings;
        wanted.width = 64;
        wanted.height = 48;
        wanted.maxDepth = 7;
        wanted.russianRoulette = false;
        EXPECT_EQ(config.settings, wanted) << i;
        EXPECT_EQ(config.scene, "veach-mis");
        EXPECT_EQ(poseOf(config.camera, {}), state.work.camera);
        EXPECT_EQ(config.engine, i == 2 ? "query" : "multi");
        EXPECT_EQ(config.threads, i == 2 ? 0u : 1u);
        EXPECT_EQ(config.denoise, i == 1 ? bench::Denoise::On : bench::Denoise::Off);
    }
    // The first is what the others are compared with.
    bench::Config base = configs[1];
    for (const auto& [axis, value] : suite.experiments[0].baseline) axis->set(base, value);
    EXPECT_EQ(bench::keyOf(base), bench::keyOf(configs[0]));
}

TEST(RaceFiles, AnEditedSceneIsNamedByItsFile) {
    RaceState state = raceOf(twoEntrants().entrants);
    state.work.request.edits = 1;
    EXPECT_EQ(whyNoSuite(state), nullptr);
    const std::string file = (std::filesystem::current_path() / "race-scene.json").string(); // which is none yet
    const bench::Suite suite = bench::parseSuite(raceSuite(state, false, file), "race.json");
    for (const bench::Config& config : bench::combinations(suite.experiments.at(0), 4)) EXPECT_EQ(config.scene, file);
}

TEST(RaceFiles, WhatASuiteCannotSayIsTold) {
    const RaceState plain = raceOf(twoEntrants().entrants);
    RaceState state = plain;
    state.work.request.moment.time = 0.5;
    EXPECT_NE(whyNoSuite(state), nullptr);
    state = plain;
    state.work.request.oneSidedLights = false;
    EXPECT_NE(whyNoSuite(state), nullptr);
    state = plain;
    state.work.settings.features = shared::kFeatureAll;
    EXPECT_NE(whyNoSuite(state), nullptr);
}

} // namespace
} // namespace rt::app
