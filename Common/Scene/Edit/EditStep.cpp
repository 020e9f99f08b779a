#include "Common/Scene/Edit/EditStep.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Scene/Edit/EditText.h"
#include "Common/Scene/Json/JsonText.h"

namespace rt::scene {

namespace {

// In the order of EditStep::Kind.
constexpr std::array<const char*, 5> kStepKinds = {"perform", "give_up", "join", "undo", "redo"};

bool isOfGesture(const EditStep& step, std::uint64_t gesture) {
    return step.kind == EditStep::Kind::Perform && gesture != 0 && step.gesture == gesture;
}

// Whether each of the later edits sets anew what its counterpart has set, as a slider does.
bool replacesAll(const std::vector<SceneEdit>& later, const std::vector<SceneEdit>& earlier) {
    const auto isReplaced = [](const SceneEdit& edit, const SceneEdit& before) {
        return edit.index() == before.index() && !changesStructure(edit) && !changesStructure(before) &&
               replaces(edit, before);
    };
    return std::equal(later.begin(), later.end(), earlier.begin(), earlier.end(), isReplaced);
}

} // namespace

void repeat(SceneDocument& document, EditStep step) {
    switch (step.kind) {
        case EditStep::Kind::Perform:
            return document.perform(std::move(step.name), std::move(step.edits), step.gesture);
        case EditStep::Kind::GiveUp:
            return document.giveUp(step.gesture);
        case EditStep::Kind::Join:
            return document.joinSteps(std::move(step.name));
        case EditStep::Kind::Undo:
            document.undo();
            return;
        case EditStep::Kind::Redo:
            document.redo();
    }
}

void appendStep(std::vector<EditStep>& steps, EditStep step, std::uint64_t seenGesture) {
    if (step.kind == EditStep::Kind::GiveUp) {
        const std::size_t before = steps.size();
        while (!steps.empty() && isOfGesture(steps.back(), step.gesture)) steps.pop_back();
        // All that it takes back has been left out, unless the gesture began with a step that somebody has seen.
        const bool isFirst = steps.empty() && seenGesture != step.gesture;
        const bool isAfterAnother = !steps.empty() && (steps.back().kind == EditStep::Kind::Perform ||
                                                       steps.back().kind == EditStep::Kind::GiveUp);
        if (steps.size() < before && isAfterAnother) steps.back().leavesUnsaved = step.leavesUnsaved;
        if (steps.size() < before && (isFirst || isAfterAnother)) return;
    }
    if (step.kind == EditStep::Kind::Perform && !steps.empty() && isOfGesture(steps.back(), step.gesture) &&
        replacesAll(step.edits, steps.back().edits)) {
        step.name = std::move(steps.back().name); // a step of the history has that of its first edits
        steps.back() = std::move(step);
        return;
    }
    steps.push_back(std::move(step));
}

std::string toText(const EditStep& step) {
    const nlohmann::json name(step.name);
    std::string text = std::string(R"({"step": ")") + kStepKinds[static_cast<std::size_t>(step.kind)] + '"' +
                       R"(, "name": )" + name.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
                       R"(, "gesture": )" + std::to_string(step.gesture) + R"(, "edits": [)";
    for (std::size_t i = 0; i < step.edits.size(); ++i) text += (i == 0 ? "" : ", ") + toText(step.edits[i]);
    return text + "]}";
}

EditStep parseStep(const std::string& line, const std::string& file, const std::string& assetsBelow) {
    const LargeJson json(parseJson(line, file));
    const JsonNode node(*json, file);
    node.expectKeys({"step", "name", "gesture", "edits"});
    const std::string kind = node.at("step").string();
    const auto found = std::find(kStepKinds.begin(), kStepKinds.end(), kind);
    if (found == kStepKinds.end()) node.at("step").failValue("the name of a step");
    EditStep step;
    step.kind = static_cast<EditStep::Kind>(std::distance(kStepKinds.begin(), found));
    step.name = node.at("name").string();
    step.gesture = node.at("gesture").unsignedInteger();
    node.at("edits").forEachElement([&](const JsonNode& edit) { step.edits.push_back(parseEdit(edit, assetsBelow)); });
    return step;
}

} // namespace rt::scene
