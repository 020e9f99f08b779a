// A film as a picture with less noise, by features that its engine makes.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Film.h"
#include "Common/Render/Engine.h"
#include "Common/Render/PictureDenoiser.h"

namespace rt::app {

// What statistics say of it.
struct DenoiseFigures {
    image::RelMseEstimate relmse;
    double seconds = 0; // of features and filter
    std::array<double, image::kDenoiseCandidates> shares{};
    std::string device{}; // as of a DenoisedPicture
    std::vector<DenoisePassTime> passes{};
    std::string library{}; // that has filtered, which says no more; empty: this program
};

class FilmDenoiser {
  public:
    // Both must outlive this; the engine has a scene.
    FilmDenoiser(const Options& options, Engine& engine) : options_(options), engine_(engine) {}

    // Of the region if there is one, black outside. Throws InputError when the film has no two halves, and what the
    // engine throws.
    image::Denoised denoise(const image::Film& film);
    const DenoiseFigures& figures() const { return figures_; } // of the last one

  private:
    void renderFeatures();
    image::Denoised denoiseByLibrary(const image::Film& film);
    DenoisedPicture filter(image::DenoiseInput& input); // of the region, if there is one

    const Options& options_;
    Engine& engine_;
    std::optional<AovImages> features_; // made once, where they are not the engine's business
    DenoiseFigures figures_;
};

} // namespace rt::app
