#include "Common/Image/Denoise/FilterTile.h"

#include "Common/Image/Denoise/GuideRow.h"

rt::image::DenoiseKernels rt::image::denoiseKernels_x86_64_v2() {
    return {filterTile, smoothGuideRow};
}
