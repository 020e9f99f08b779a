// What a user does to a scene that is edited, one thing after the other: done again to the same scene they lead to the
// same document, history and all.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "Common/Scene/Edit/SceneDocument.h"

namespace rt::scene {

struct EditStep {
    enum class Kind { Perform, GiveUp, Join, Undo, Redo }; // what SceneDocument has by these names
    Kind kind = Kind::Perform;
    std::string name{};             // of the history's step
    std::vector<SceneEdit> edits{}; // Perform
    std::uint64_t gesture = 0;      // Perform, GiveUp
    bool leavesUnsaved = true;      // afterwards there is something that is not saved
};

// Throws what the document does.
void repeat(SceneDocument& document, EditStep step);

// Adds a step to those that nobody has seen yet: what it makes needless is left out, as of a drag all but its end.
// `seenGesture`: of the last step that somebody has seen, or 0.
void appendStep(std::vector<EditStep>& steps, EditStep step, std::uint64_t seenGesture);

// One line of JSON, but for what it leaves. Throws InputError, as EditText.h says, and so does its reverse.
std::string toText(const EditStep& step);
EditStep parseStep(const std::string& line, const std::string& file, const std::string& assetsBelow = {});

} // namespace rt::scene
