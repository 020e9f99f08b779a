#include "Common/Bench/ReferenceRows.h"

#include <cmath>

#include "Common/Bench/Config.h"

namespace rt::bench {

ReferenceRow makeReferenceRow(const std::string& scene, const ReferenceRequest& request, const std::string& engine,
                              const ReferenceResult& made, const image::Reference& reference) {
    double variance = 0;
    for (const float value : reference.variance.data) variance += value;
    ReferenceRow row{scene, request.width, request.height, request.maxDepth, engine, {}, {}, {}, false, false, "", {}};
    row.spp = static_cast<double>(made.spp);
    row.seconds = made.seconds;
    row.rmse = std::sqrt(variance / static_cast<double>(reference.variance.data.size()));
    row.cached = made.cached;
    row.sufficient = made.sufficient;
    return row;
}

void verifyReference(const std::vector<std::vector<Row>>& rows, ReferenceRow& reference) {
    for (const std::vector<Row>& own : rows)
        for (const Row& row : own) {
            if (row.config.imported || !row.biasZ) continue;
            if (isGpuEngine(row.config.engine) == isGpuEngine(reference.engine)) continue;
            reference.verifiedBy = row.config.engine;
            if (!reference.verifiedZ || std::abs(*row.biasZ) > std::abs(*reference.verifiedZ))
                reference.verifiedZ = row.biasZ;
        }
}

void keepReference(const ReferenceRow& row, std::vector<ReferenceRow>& rows) {
    for (ReferenceRow& earlier : rows) {
        if (earlier.scene != row.scene || earlier.width != row.width || earlier.height != row.height ||
            earlier.maxDepth != row.maxDepth)
            continue;
        ReferenceRow both = row;
        both.seconds = earlier.seconds.value_or(0) + row.seconds.value_or(0);
        both.cached = earlier.cached;
        if (std::abs(earlier.verifiedZ.value_or(0)) >= std::abs(row.verifiedZ.value_or(0))) {
            both.verifiedBy = earlier.verifiedBy;
            both.verifiedZ = earlier.verifiedZ;
        }
        earlier = both;
        return;
    }
    rows.push_back(row);
}

} // namespace rt::bench
