// What results say of the references that errors were measured by.
#pragma once
#include <string>
#include <vector>

#include "Common/Bench/ReferenceStore.h"
#include "Common/Bench/Results.h"
#include "Common/Image/ErrorAnalysis.h"

namespace rt::bench {

// Of a scene's reference, by this engine. `reference` is what `made` held.
ReferenceRow makeReferenceRow(const std::string& scene, const ReferenceRequest& request, const std::string& engine,
                              const ReferenceResult& made, const image::Reference& reference);

// An engine of another kind finds the same image, or one of the two is wrong.
void verifyReference(const std::vector<std::vector<Row>>& rows, ReferenceRow& reference);

// A row for each reference, however many experiments it serves.
void keepReference(const ReferenceRow& row, std::vector<ReferenceRow>& rows);

} // namespace rt::bench
