#include "Common/Image/Denoise/LiveRow.h"

rt::image::LiveKernel rt::image::liveKernel_generic() {
    return filterRow;
}
