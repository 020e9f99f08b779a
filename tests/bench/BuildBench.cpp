// Time to build the CPU engine's acceleration structure and Embree's of the same geometry, on the same threads in one
// run, and the memory that each holds afterwards. The two take turns and medians are compared.
//   build-bench [REPEATS] [THREADS]
#include <algorithm>
#include <cstdio>

#ifndef RT_HAS_EMBREE

int main() {
    std::puts("build-bench compares with Embree 3, which this build has not found.");
    return 1;
}

#else

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "Common/Core/CpuFeatures.h"
#include "tests/bench/AccelBenchScenes.h"

namespace rt::bench {
namespace {

std::atomic<std::ptrdiff_t> embreeBytes{0};

bool countBytes(void*, ssize_t bytes, bool) {
    embreeBytes += bytes;
    return true;
}

double seconds(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void compare(const BenchScene& scene, RTCDevice device, std::size_t threads, int repeats) {
    accel::BuildSettings settings;
    settings.tree.threads = threads;
    std::vector<double> ours, theirs, ratios;
    double ourBytes = 0, theirBytes = 0;
    for (int i = 0; i < repeats; ++i) {
        std::unique_ptr<accel::CpuAccel> accel;
        ours.push_back(seconds([&] { accel = accel::CpuAccel::build(scene.input(), settings); }));
        ourBytes = static_cast<double>(accel->bytes());
        accel.reset();
        EmbreeScene embree(device, scene);
        const std::ptrdiff_t before = embreeBytes; // its copies of vertices and indices
        theirs.push_back(seconds([&] { embree.commit(); }));
        theirBytes = static_cast<double>(embreeBytes - before);
        ratios.push_back(theirs.back() / ours.back());
    }
    const auto count = static_cast<double>(scene.primitives());
    std::printf("%-10s %11zu %9.3f %9.3f %7.2f %14.1f %14.1f\n", scene.name.c_str(), scene.primitives(), median(ours),
                median(theirs), median(ratios), ourBytes / count, theirBytes / count);
    std::fflush(stdout);
}

} // namespace
} // namespace rt::bench

int main(int argc, char** argv) {
    using namespace rt::bench;
    const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
    const int all = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const int threads = argc > 2 ? std::clamp(std::atoi(argv[2]), 1, all) : all;
    std::printf(
        "%d thread(s), %s, %s; Embree %s, medium quality, robust. Median of %d; ratio above 1: ours is faster.\n",
        threads, rt::processorName(), rt::name(rt::bestInstructionSet()), RTC_VERSION_STRING, repeats);
    std::printf("%-10s %11s %9s %9s %7s %14s %14s\n", "scene", "primitives", "ours, s", "Embree, s", "ratio",
                "ours, B/prim.", "Embree, B/prim.");
    RTCDevice device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    rtcSetDeviceMemoryMonitorFunction(device, countBytes, nullptr);
    compare(meshScene(288), device, static_cast<std::size_t>(threads), repeats);
    compare(sphereCloud(), device, static_cast<std::size_t>(threads), repeats);
    rtcReleaseDevice(device);
}

#endif
