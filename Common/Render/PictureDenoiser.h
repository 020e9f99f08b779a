// Pictures with less noise of the film that an engine holds, for whoever looks at it while it converges.
// docs/denoising.md has the filters.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Render/Engine.h"

namespace rt::app {

enum class DenoiseQuality {
    Live, // in milliseconds, for a picture that converges or moves; what error it still has is not known
    Final // what --denoise writes
};

struct DenoiseRequest {
    DenoiseQuality quality = DenoiseQuality::Final;
    bool details = false; // of Final: both halves, the error, and the bandwidth of each pixel, beside the picture
    std::uint32_t featureSamples = kAovSamples; // of each pixel, at least, where features are rendered for it
};

struct DenoisePassTime {
    std::string name;
    double seconds = 0;
};

// What was not asked for, or is not known, has no pixels.
struct DenoisedPicture {
    DenoiseQuality quality = DenoiseQuality::Final;
    image::Denoised images; // of Live only the picture; the rest of it has no meaning then
    double seconds = 0;     // of features and filter
    std::string device{};   // that has filtered, and its passes; empty: the processor
    std::vector<DenoisePassTime> passes{};
};

// Of one film: made by Engine::makeDenoiser() after reset(), and of no use after the next one. What takes long to make,
// as pipelines of a device, belongs to the engine. Used by the thread that drives the engine, between its calls, so
// that its time is none of sampling.
class PictureDenoiser {
  public:
    virtual ~PictureDenoiser() = default;

    // Whether live pictures are worth their time. They are not where the film has to be copied first: then pictures
    // wait until the film rests.
    virtual bool isQuick() const { return true; }

    // Whether live pictures need two halves of the film's samples, too: a film of one sample a pixel has none.
    virtual bool needsHalves() const { return true; }

    // The film as it is, which stays as it is. None where `cancel` became true, and where the film has no two halves of
    // its samples that are needed, or lacks one in some pixel as yet. Returns within 100 ms once `cancel` is true; what
    // it has made of features by then is kept for the next call. Throws what the engine throws.
    virtual std::optional<DenoisedPicture> denoise(const DenoiseRequest& request, const std::atomic<bool>& cancel) = 0;
};

// By the processor, for any engine that has its film on the host or can bring it there; the engine must outlive it.
std::unique_ptr<PictureDenoiser> makeHostDenoiser(Engine& engine);

} // namespace rt::app
