// Open Image Denoise 2, where the user's machine has it: a trained filter to compare the own one with. Nothing needs
// it; it is loaded when it is asked for, and called by its C interface.
#pragma once
#include <filesystem>
#include <string>

#include "Common/App/Platform.h"
#include "Common/Image/Image.h"

namespace rt::app {

class OpenImageDenoise {
  public:
    // `library`: a file instead of the system's. Throws RenderError where there is none, or not of version 2.
    explicit OpenImageDenoise(const std::filesystem::path& library = {});

    const std::string& name() const { return name_; } // with its version

    // Linear radiance as the library makes it, on the processor. Albedo and normal of the surfaces in sight, of the
    // same size. Throws RenderError with what the library says.
    image::Image filter(image::Image radiance, image::Image albedo, image::Image normal) const;

  private:
    template <class Function>
    Function* call(const char* function) const;

    SharedLibrary library_;
    std::string name_ = "Open Image Denoise";
};

} // namespace rt::app
