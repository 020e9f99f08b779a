// The session of a window with an engine whose samples cost nothing, without any window.
#pragma once
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "Common/App/Interactive/InteractiveSession.h"
#include "tests/TempFolder.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {

// Takes its time for a sample, and gives up when told to.
class SlowEngine : public FakeEngine {
  public:
    inline static std::atomic<int> films{0};    // begun
    inline static std::atomic<int> restored{0}; // of those

    RenderStatus renderSome(const Budget& budget) override {
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
        while (std::chrono::steady_clock::now() < end) {
            if (budget.cancel != nullptr && budget.cancel->load()) return last_;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return last_ = FakeEngine::renderSome(budget);
    }
    void reset(const scene::CameraDesc& camera, const RenderSettings& settings) override {
        FakeEngine::reset(camera, settings);
        ++films;
        last_ = {};
        last_.samplesTotal = std::uint64_t{settings.width} * settings.height * settings.spp;
    }

    void restore(image::Film film) override {
        FakeEngine::restore(std::move(film));
        ++restored;
    }

  private:
    RenderStatus last_;
};

class InteractiveFixture : public testing::Test {
  protected:
    static InteractiveSession::Setup setup(std::uint32_t spp) {
        InteractiveSession::Setup setup;
        setup.options.program = "ray-tracing-cpu";
        setup.makeEngine = [](const EngineChoice&) { return std::make_unique<SlowEngine>(); };
        setup.request.size.width = 24;
        setup.request.settings.spp = spp;
        setup.scene = {"cornell-box-lights", true};
        return setup;
    }
    // Waits until the state is as wanted; the time only ends a test that fails.
    template <class Condition>
    static bool reaches(const InteractiveSession& session, Condition condition) {
        for (int i = 0; i < 20'000; ++i) {
            if (condition(session.state())) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }
    static bool isFinished(const SessionState& state) { return state.activity == Activity::Finished; }

    test::TempFolder folder_;
};

} // namespace rt::app
