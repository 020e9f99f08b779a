#include "Common/Image/Denoise/FilterTile.h"

#include "Common/Image/Denoise/GuideRow.h"

rt::image::DenoiseKernels rt::image::denoiseKernels_generic() {
    return {filterTile, smoothGuideRow};
}
