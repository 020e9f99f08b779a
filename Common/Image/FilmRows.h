// What a film shows, a row at a time. The film must outlive the rows and stay as it is.
#pragma once
#include "Common/Image/Film.h"
#include "Common/Image/ImageRows.h"

namespace rt::image {

ImageRows meanRows(const Film& film);        // as Film::resolve()
ImageRows varianceRows(const Film& film);    // as Film::varianceOfMean(), under the same conditions
ImageRows sampleCountRows(const Film& film); // as Film::sampleCounts(): one channel

} // namespace rt::image
