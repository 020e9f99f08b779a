// The image that the films of one view are compared with, and the error of the present film over time.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/App/Session/ReferenceCache.h"
#include "Common/Image/Image.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/FilmRun.h"

namespace rt::app {

// A film that was rendered as a reference, resolved, and its own relMSE; 0: not known.
struct RenderedReference {
    image::Image image;
    double error = 0;
};
RenderedReference referenceOf(const image::Film& film);

class FilmReference {
  public:
    // A film that is to become the reference; the one before stays until then.
    void render(std::uint32_t spp) { renderedSpp_ = spp; }
    void giveUp() { renderedSpp_.reset(); }
    std::optional<std::uint32_t> renderedSpp() const { return renderedSpp_; } // none: another film is rendered

    // Another film, with an error curve of its own.
    void begin(const ReferenceKey& film);
    const ReferenceKey& film() const { return filmKey_; }
    // A linear image of the present film's view, whose own relMSE is `error` (0: not known), becomes the reference.
    void set(image::Image image, double error = 0);
    // Whether the present film is to be compared: it agrees with the reference in scene, camera, size and depth.
    bool fits() const { return image_ && !renderedSpp_ && key_ == filmKey_; }
    const image::Image& image() const { return *image_; }                          // requires fits()
    const std::shared_ptr<const image::Image>& shared() const { return image_; }   // null: there is none
    double error() const { return error_; }                                        // requires fits()
    std::optional<image::ErrorFigures> compare(const image::Image& picture) const; // none unless it fits

    // The error of a picture of the film, at times that grow by a tenth; of the last picture always.
    void follow(const FilmRun& film, const image::Image& picture);
    const std::vector<ErrorPoint>& curve() const { return curve_; }

  private:
    std::optional<std::uint32_t> renderedSpp_;
    std::shared_ptr<const image::Image> image_;
    double error_ = 0;
    ReferenceKey key_, filmKey_; // what a film must agree in with the reference
    std::vector<ErrorPoint> curve_;
};

} // namespace rt::app
