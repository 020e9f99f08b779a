#include "Common/Scene/Edit/SceneDocument.h"

#include <iterator>

#include "Common/Scene/Edit/EditCheck.h"

namespace rt::scene {

void SceneDocument::apply(SceneEdit& edit) {
    journal_.push_back(edit);
    ++revision_;
    const bool changes = changesStructure(edit);
    exchange(scene_, edit);
    if (changes || changesStructure(edit)) structure_ = revision_; // by what came, or by what went
}

void SceneDocument::perform(std::string name, std::vector<SceneEdit> edits, std::uint64_t gesture) {
    const std::size_t journalled = journal_.size();
    std::size_t done = 0;
    try {
        for (; done < edits.size(); ++done) { // each in the scene that those before it have made
            checkEdit(scene_, edits[done]);
            apply(edits[done]);
        }
    } catch (...) {
        while (done > 0) exchange(scene_, edits[--done]);
        journal_.resize(journalled);
        throw;
    }
    append({std::move(name), std::move(edits), gesture});
}

// A saved state stays one that undo comes by.
bool SceneDocument::joins(const Step& step) const {
    return step.gesture != 0 && position_ > 0 && steps_[position_ - 1].gesture == step.gesture && savedAt_ != position_;
}

void SceneDocument::append(Step step) {
    if (savedAt_ && *savedAt_ > position_) savedAt_.reset();
    steps_.resize(position_);
    if (!joins(step)) {
        steps_.push_back(std::move(step));
        ++position_;
        return;
    }
    std::vector<SceneEdit>& kept = steps_.back().edits;
    for (SceneEdit& edit : step.edits) {
        // From the last one back to where paths may have meant something else.
        bool isReplaced = false;
        for (auto earlier = kept.rbegin(); earlier != kept.rend() && !isReplaced; ++earlier) {
            isReplaced = replaces(edit, *earlier);
            if (!isReplaced && changesStructure(*earlier)) break;
        }
        if (!isReplaced) kept.push_back(std::move(edit));
    }
}

bool SceneDocument::undo() {
    if (position_ == 0) return false;
    std::vector<SceneEdit>& edits = steps_[--position_].edits;
    for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) apply(*edit);
    return true;
}

bool SceneDocument::redo() {
    if (position_ == steps_.size()) return false;
    for (SceneEdit& edit : steps_[position_++].edits) apply(edit);
    return true;
}

void SceneDocument::giveUp(std::uint64_t gesture) {
    if (gesture == 0 || position_ == 0 || steps_[position_ - 1].gesture != gesture) return;
    undo();
    steps_.resize(position_);
}

void SceneDocument::joinSteps(std::string name) {
    if (position_ < 2 || position_ != steps_.size() || savedAt_ == position_ - 1) return;
    Step later = std::move(steps_.back());
    steps_.pop_back();
    Step& step = steps_.back();
    step.name = std::move(name);
    step.gesture = later.gesture;
    step.edits.insert(step.edits.end(), std::make_move_iterator(later.edits.begin()),
                      std::make_move_iterator(later.edits.end()));
    if (savedAt_ == position_) savedAt_ = position_ - 1;
    --position_;
}

std::size_t SceneDocument::historyBytes() const {
    std::size_t sum = steps_.capacity() * sizeof(Step);
    for (const Step& step : steps_) {
        sum += step.name.capacity();
        for (const SceneEdit& edit : step.edits) sum += bytesOf(edit);
    }
    return sum;
}

} // namespace rt::scene
