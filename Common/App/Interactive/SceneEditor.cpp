#include "Common/App/Interactive/SceneEditor.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "Common/App/Interactive/SceneFileText.h"
#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Edit/ObjectMotion.h"

namespace rt::app {

using scene::EditStep;

namespace {

template <typename Value>
bool isThere(const std::future<Value>& future) {
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

} // namespace

SceneEditor::~SceneEditor() {
    if (callOff_) *callOff_ = true; // the futures wait for their threads
}

void SceneEditor::end() {
    if (document_) session_.stopEditing();
    if (callOff_) *callOff_ = true;
    if (document_ && autosave_ != nullptr) autosave_->end();
    document_.reset();
    notes_.clear();
    sinceSaved_.clear();
    selected_.set(std::nullopt);
    journal_.clear();
    outlined_ = {};
    reading_ = {};
}

void SceneEditor::follow(const SessionState& state) {
    source_ = state.source;
    moment_ = state.moment;
    if (state.sceneReads > sceneReads_) { // of several viewports some come to a scene later than others
        sceneReads_ = state.sceneReads;
        end();
    }
    if (isThere(saving_)) finishSaving();
    if (!isThere(reading_)) return;
    Read read = reading_.get();
    document_.emplace(std::move(read.first));
    session_.startEditing(std::move(read.second));
    beginAutosave(source_, moment_, readMark_);
    structureEdits_ = sentStructure_ = 0;
    // The file may have become another one since it was rendered.
    if (markOf(source_) != state.sourceMark) structureEdits_ = edits_ = session_.edit({}, false);
}

void SceneEditor::finishSaving() {
    std::vector<EditStep> since = std::exchange(sinceSaved_, {});
    try {
        saved_ = saving_.get();
    } catch (...) {
        if (document_) document_->markUnsaved();
        throw;
    }
    savedMark_ = markOf(*saved_);
    session_.nameEdited(*saved_);
    if (!document_) return;
    const bool goesOn = !since.empty();
    beginAutosave(*saved_, {}, savedMark_);
    keepsEdits_ = keepsEdits_ || goesOn;
    for (EditStep& step : since)
        if (autosave_ != nullptr) autosave_->add(std::move(step));
}

// ---- for the case of a crash ---------------------------------------------------------------------------------------

void SceneEditor::beginAutosave(const std::string& source, const scene::Moment& moment,
                                std::optional<FileFingerprint> mark) {
    keptFrom_ = document_->position();
    keepsEdits_ = document_->stepCount() > keptFrom_; // which redo would lead to
    if (autosave_ != nullptr)
        autosave_->begin({wholeSource(source), document_->scene().title, moment, std::move(mark)});
}

void SceneEditor::note(EditStep step) {
    if (autosave_ != nullptr) notes_.push_back(std::move(step));
}

// By the steps where those lead back to nothing that the autosave does not know, else by what they have come to.
void SceneEditor::keepNotes() {
    if (autosave_ == nullptr) return;
    std::vector<EditStep> steps = std::exchange(notes_, {});
    if (keepsEdits_) {
        steps.clear();
        if (journal_.empty()) return;
        steps.push_back({EditStep::Kind::Perform, "Edits", journal_});
    }
    for (EditStep& step : steps) {
        step.leavesUnsaved = isDirty();
        if (saving_.valid()) sinceSaved_.push_back(step);
        autosave_->add(std::move(step));
    }
}

void SceneEditor::repeat(std::vector<EditStep> steps) {
    std::map<std::uint64_t, std::uint64_t> gestures; // of this window, for those of the other one
    for (EditStep& step : steps) {
        if (step.gesture != 0) {
            std::uint64_t& own = gestures[step.gesture];
            if (own == 0) own = newGesture();
            step.gesture = own;
        }
        try {
            scene::repeat(*document_, step);
        } catch (...) {
            send(false);
            throw;
        }
        note(std::move(step));
    }
    send(false);
}

// ---- the document --------------------------------------------------------------------------------------------------

void SceneEditor::begin() {
    if (document_ || reading_.valid() || source_.empty() || isResting_) return;
    readMark_ = markOf(source_); // before it is read
    callOff_ = std::make_shared<std::atomic<bool>>(false);
    const auto read = [source = source_, moment = moment_, assetsBelow = assetsBelow_, callOff = callOff_] {
        const Interruptible interruptible(*callOff);
        const ReadsBelow confined(assetsBelow, source);
        scene::SceneDesc scene =
            loadScene(wholeSource(source), moment); // so that files it names are found from anywhere
        scene::SceneDesc copy = scene;
        return Read(std::move(scene), std::move(copy));
    };
    reading_ = std::async(std::launch::async, read);
}

// What it tells leads the selection along, in the order in which it was done.
void SceneEditor::followJournal() {
    for (scene::SceneEdit& edit : document_->takeJournal()) {
        selected_.follow(edit);
        journal_.push_back(std::move(edit));
    }
}

void SceneEditor::send(bool isGesture) {
    followJournal();
    keepNotes();
    if (journal_.empty()) return;
    selected_.keepExisting(document_->scene());
    edits_ = session_.edit(std::exchange(journal_, {}), isGesture);
    if (std::exchange(sentStructure_, document_->structure()) != document_->structure()) structureEdits_ = edits_;
}

void SceneEditor::perform(std::string name, std::vector<scene::SceneEdit> edits, std::uint64_t gesture) {
    std::vector<scene::SceneEdit> kept;
    if (autosave_ != nullptr && !keepsEdits_) kept = edits;
    std::string keptName = name;
    document_->perform(std::move(name), std::move(edits), gesture);
    note({EditStep::Kind::Perform, std::move(keptName), std::move(kept), gesture});
    send(gesture != 0);
}

void SceneEditor::performAnew(std::string name, const MakeEdits& make, std::uint64_t gesture) {
    takeBack(gesture);
    followJournal();
    try {
        std::vector<scene::SceneEdit> edits = make(document_->scene());
        EditStep step{EditStep::Kind::Perform, name, edits, gesture};
        document_->perform(std::move(name), std::move(edits), gesture);
        note(std::move(step));
    } catch (...) {
        send(true);
        throw;
    }
    send(true);
}

void SceneEditor::takeBack(std::uint64_t gesture) {
    const std::size_t before = document_->position();
    document_->giveUp(gesture);
    if (document_->position() < std::min(before, keptFrom_)) keepsEdits_ = true;
    if (document_->position() < before) note({EditStep::Kind::GiveUp, {}, {}, gesture});
}

void SceneEditor::giveUp(std::uint64_t gesture) {
    takeBack(gesture);
    send(false);
}

void SceneEditor::joinSteps(std::string name) {
    note({EditStep::Kind::Join, name});
    if (document_->position() < keptFrom_ + 2) keepsEdits_ = true;
    document_->joinSteps(std::move(name));
    keepNotes();
}

void SceneEditor::undo() {
    if (document_->position() <= keptFrom_) keepsEdits_ = true;
    if (document_->undo()) note({EditStep::Kind::Undo});
    send(false);
}

void SceneEditor::redo() {
    if (document_->redo()) note({EditStep::Kind::Redo});
    send(false);
}

void SceneEditor::save(const std::string& file) {
    if (saving_.valid()) return;
    const auto write = [scene = document_->scene(), file, source = wholeSource(source_), moment = moment_,
                        assetsBelow = assetsBelow_] {
        const ReadsBelow confined(assetsBelow, source);
        writeText(file, sceneFileText(scene, source, moment, file));
        return file;
    };
    saving_ = std::async(std::launch::async, write);
    document_->markSaved(); // unless it fails
    keepsEdits_ = true;     // what is done meanwhile counts for the file before and for the one that is written
}

bool SceneEditor::isInStep(const SessionState& state) const {
    return document_ && state.scene && state.sceneEdits >= structureEdits_;
}

void SceneEditor::select(std::optional<scene::ObjectPath> path) {
    if (path && findObject(document_->scene(), *path) == nullptr) path.reset();
    selected_.set(std::move(path));
}

void SceneEditor::select(std::vector<scene::ObjectPath> paths, const scene::ObjectPath& active) {
    selected_.set(std::move(paths), active);
    selected_.keepExisting(document_->scene());
}

void SceneEditor::toggle(const scene::ObjectPath& path) {
    if (findObject(document_->scene(), path) != nullptr) selected_.toggle(path);
}

const SelectionOutline& SceneEditor::outline(const SessionState& state) {
    const bool isNamed = isInStep(state);
    const Outlined wanted{isNamed ? state.scene : nullptr, selected_.serial(), document_ ? document_->revision() : 0};
    if (wanted == outlined_) return outline_;
    outlined_ = wanted;
    outline_ = {};
    if (!document_) return outline_;
    if (isNamed) outline_.boxes = boundsOf(*state.scene, leavesOf(document_->scene(), selected_.paths()));
    for (const scene::ObjectPath& path : selected_.paths()) {
        if (const auto light = lightPosition(document_->scene(), path)) outline_.lights.push_back(*light);
        outline_.boxes.push_back(mediumBounds(document_->scene(), path));
    }
    std::erase_if(outline_.boxes, [](const scene::Bounds& box) { return box.empty(); });
    for (const scene::Bounds& box : outline_.boxes) outline_.all.add(box, {});
    for (const glm::dvec3& light : outline_.lights) outline_.all.add(light);
    return outline_;
}

} // namespace rt::app
