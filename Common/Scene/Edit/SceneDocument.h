// A scene that is edited, with its history.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Common/Scene/Edit/SceneEdit.h"

namespace rt::scene {

class SceneDocument {
  public:
    explicit SceneDocument(SceneDesc scene) : scene_(std::move(scene)) {}

    const SceneDesc& scene() const { return scene_; }

    // One step of the history: all of the edits or, throwing InputError, none of them. Steps of one gesture, such as a
    // drag, become one; 0: the step is none of a gesture.
    void perform(std::string name, std::vector<SceneEdit> edits, std::uint64_t gesture = 0);
    bool undo(); // false: there is nothing to undo
    bool redo();
    void giveUp(std::uint64_t gesture); // the latest step, where it is of that: as if it had never been
    void joinSteps(std::string name);   // the latest two, unless it was saved in between, become one

    // The names of all steps, of which the first position() are done.
    std::size_t position() const { return position_; }
    std::size_t stepCount() const { return steps_.size(); }
    const std::string& stepName(std::size_t step) const { return steps_[step].name; }

    bool isDirty() const { return savedAt_ != position_; }
    void markSaved() { savedAt_ = position_; }
    void markUnsaved() { savedAt_.reset(); }
    std::size_t historyBytes() const;

    std::uint64_t revision() const { return revision_; }   // grows with each change
    std::uint64_t structure() const { return structure_; } // the latest that changed which objects there are

    // What has been done to the scene since the last call, in order: a copy that gets the same is the same scene.
    std::vector<SceneEdit> takeJournal() { return std::exchange(journal_, {}); }

  private:
    struct Step {
        std::string name;
        std::vector<SceneEdit> edits; // done: what undoes them, last one first
        std::uint64_t gesture = 0;
    };
    void apply(SceneEdit& edit);
    bool joins(const Step& step) const;
    void append(Step step);

    SceneDesc scene_;
    std::vector<Step> steps_;
    std::size_t position_ = 0;
    std::optional<std::size_t> savedAt_ = 0; // none: no step leads back there
    std::uint64_t revision_ = 0, structure_ = 0;
    std::vector<SceneEdit> journal_;
};

} // namespace rt::scene
