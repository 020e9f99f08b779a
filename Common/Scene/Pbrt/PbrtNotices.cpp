#include "Common/Scene/Pbrt/PbrtNotices.h"

#include "Common/Core/Printable.h"
#include "Common/Scene/Counted.h"

namespace rt::scene {

void PbrtNotices::add(const std::string& what, const PbrtPlace& place) {
    const auto [index, isNew] = indices_.try_emplace(what, entries_.size());
    if (isNew) entries_.push_back({place.text() + ": " + what, 0});
    ++entries_[index->second].count;
}

void PbrtNotices::addUnused(const PbrtParameters& parameters) {
    for (const PbrtParameter* parameter : parameters.unused())
        add(parameters.what + ": " + printable(parameter->label(), 100) + " is left out", parameter->place);
}

void PbrtNotices::appendTo(std::vector<std::string>& notices) const {
    for (const Entry& entry : entries_)
        notices.push_back(entry.count == 1 ? entry.text
                                           : entry.text + "; " + counted(entry.count, "time", "times") + " in all");
}

} // namespace rt::scene
