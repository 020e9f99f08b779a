// What a film shows, a row at a time. The film must outlive the rows and stay as it is.
#pragma once
#include "Common/Image/Film.h"
#include "Common/Image/ImageRows.h"

namespace rt::image {

ImageRows meanRows(const Film& film); // as Film::resolve()
// The same of the replicates of one half only, 0 or 1 as Film::halfOf() counts them.
ImageRows halfRows(const Film& film, std::uint32_t half);
ImageRows varianceRows(const Film& film);    // as Film::varianceOfMean(), under the same conditions
ImageRows sampleCountRows(const Film& film); // as Film::sampleCounts(): one channel

} // namespace rt::image
