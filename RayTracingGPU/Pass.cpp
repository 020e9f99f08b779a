#include "RayTracingGPU/Pass.h"

#include <algorithm>

namespace rt::gpu {
namespace {

constexpr std::uint64_t kPassPart = 8;     // launches share passes that take a film of n samples n / 8 further
constexpr std::uint64_t kMaxPass = 64;     // samples, likewise
constexpr std::uint64_t kRegionRounds = 8; // of blocks in a pass where regions take turns; a turn costs two copies

} // namespace

// Where two launches take all pixels several samples further, they are a pass: one would have to wait for the paths of
// the pass before. Where they take them few samples or not even one, more launches share a pass, so that none is much
// shorter than it may be. Large films go on by whole blocks.
Pass planPass(const DeviceFilm& region, std::uint64_t begun, std::uint64_t spp, std::uint64_t fitting,
              std::uint64_t wanted, std::uint64_t maximum) {
    const std::uint64_t replicates = region.replicates();
    const std::uint64_t stepSamples = region.stepSamples();
    const std::uint64_t round = shared::kBlock * replicates; // samples per pixel
    std::uint64_t end = (begun / round + kRegionRounds) * round;
    if (region.isWhole()) {
        const std::uint64_t maxSteps = std::max<std::uint64_t>(std::min(fitting, maximum) / region.columnSamples(), 1);
        std::uint64_t steps =
            std::max(std::max(2 * fitting, wanted) / stepSamples, std::min(begun / kPassPart, kMaxPass) / replicates);
        end = begun + std::clamp<std::uint64_t>(steps, 1, maxSteps) * replicates;
    }
    end = std::min(end, spp);
    return {.end = static_cast<std::uint32_t>(end),
            .steps = static_cast<std::uint32_t>((end - begun + replicates - 1) / replicates),
            .stepSamples = stepSamples};
}

shared::FilmLaunch nextLaunch(const DeviceFilm& region, const Pass& pass, std::uint64_t fitting,
                              std::uint64_t maximum) {
    const std::uint32_t left = region.bandSlots() - pass.nextSlot;
    const std::uint32_t half = (region.bandSlots() + 1) / 2;
    const auto launchOf = [&](std::uint32_t first, std::uint32_t width) {
        shared::FilmLaunch launch{};
        region.describe(launch, first, width);
        launch.steps = pass.steps;
        launch.spp = pass.end;
        return launch;
    };
    if (region.hasPlan()) {                           // as many slots of each band as have so many samples together
        constexpr std::uint64_t kPlaces = 1ull << 32; // see PlannedSample
        const std::uint64_t numbered = kPlaces / (region.columnSamples() * pass.steps);
        const std::uint64_t largest = std::min<std::uint64_t>({left, half, numbered});
        std::uint64_t samples = region.numbersOf(launchOf(pass.nextSlot, 1));
        std::uint32_t width = 1;
        for (; width < largest; ++width) {
            samples += region.numbersOf(launchOf(pass.nextSlot + width, 1));
            if (samples > std::min(fitting, maximum)) break;
        }
        return launchOf(pass.nextSlot, width);
    }
    const std::uint64_t room = maximum / (region.columnSamples() * pass.steps);
    const std::uint64_t columns = fitting * region.bandSlots() / (pass.stepSamples * pass.steps);
    const std::uint64_t width = std::clamp<std::uint64_t>(std::min(room, columns), 1, std::min(left, half));
    const std::uint64_t launches = (left + width - 1) / width; // that take alike many
    return launchOf(pass.nextSlot, static_cast<std::uint32_t>((left + launches - 1) / launches));
}

} // namespace rt::gpu
