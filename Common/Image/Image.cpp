#include "Common/Image/Image.h"

#include "Common/Core/SystemMemory.h"

namespace rt::image {

Image::Image(std::uint32_t w, std::uint32_t h, std::uint32_t c) : width(w), height(h), channels(c) {
    resizeLarge(data, std::size_t{w} * h * c);
}

} // namespace rt::image
