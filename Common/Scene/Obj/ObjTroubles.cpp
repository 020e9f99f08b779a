#include "Common/Scene/Obj/ObjTroubles.h"

#include "Common/Scene/Counted.h"
#include "Common/Scene/Obj/ObjText.h"

namespace rt::scene {

namespace {

bool losesFaces(Trouble trouble) {
    return trouble <= Trouble::BrokenVertex;
}

std::string loss(Trouble trouble, std::size_t count) {
    if (losesFaces(trouble)) return counted(count, "face is", "faces are") + " left out";
    if (trouble == Trouble::BrokenColor) return counted(count, "vertex has", "vertices have") + " no colour";
    if (trouble <= Trouble::SomeUvs) return counted(count, "face does", "faces do") + " without texture coordinates";
    return counted(count, "face does without its normals", "faces do without their normals");
}

} // namespace

std::optional<std::string> ObjTroubles::whyNoFace(const std::string& path) const {
    const Kind* first = nullptr;
    for (std::size_t i = 0; i < kinds_.size(); ++i)
        if (losesFaces(static_cast<Trouble>(i)) && kinds_[i].count > 0 && (!first || kinds_[i].line < first->line))
            first = &kinds_[i];
    if (!first) return std::nullopt;
    return path + ":" + std::to_string(first->line) + ": " + first->message;
}

void ObjTroubles::appendNotices(const std::string& path, std::vector<std::string>& notices) const {
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        const Kind& kind = kinds_[i];
        if (kind.count == 0) continue;
        notices.push_back(path + ":" + std::to_string(kind.line) + ": " + kind.message + "; " +
                          loss(static_cast<Trouble>(i), kind.count));
    }
}

} // namespace rt::scene
