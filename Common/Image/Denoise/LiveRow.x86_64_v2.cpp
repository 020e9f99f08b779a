#include "Common/Image/Denoise/LiveRow.h"

rt::image::LiveKernel rt::image::liveKernel_x86_64_v2() {
    return filterRow;
}
