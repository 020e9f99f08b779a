#include "Common/App/Interactive/SceneEditor.h"

#include <chrono>
#include <utility>

#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Json/SceneJson.h"

namespace rt::app {
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
    document_.reset();
    selection_.reset();
    measured_ = {};
    reading_ = {};
}

void SceneEditor::follow(const SessionState& state) {
    source_ = state.source;
    moment_ = state.moment;
    if (std::exchange(sceneReads_, state.sceneReads) != state.sceneReads) end();
    if (isThere(saving_)) {
        try {
            saved_ = saving_.get();
        } catch (...) {
            if (document_) document_->markUnsaved();
            throw;
        }
        savedMark_ = markOf(*saved_);
        session_.nameEdited(*saved_);
    }
    if (!isThere(reading_)) return;
    Read read = reading_.get();
    document_.emplace(std::move(read.first));
    session_.startEditing(std::move(read.second));
    structureEdits_ = sentStructure_ = 0;
    // The file may have become another one since it was rendered.
    if (markOf(source_) != state.sourceMark) structureEdits_ = edits_ = session_.edit({}, false);
}

void SceneEditor::begin() {
    if (document_ || reading_.valid() || source_.empty()) return;
    callOff_ = std::make_shared<std::atomic<bool>>(false);
    const auto read = [source = source_, moment = moment_, assetsBelow = assetsBelow_, callOff = callOff_] {
        const Interruptible interruptible(*callOff);
        const ReadsBelow confined(assetsBelow, source);
        scene::SceneDesc scene = loadScene(source, moment);
        scene::SceneDesc copy = scene;
        return Read(std::move(scene), std::move(copy));
    };
    reading_ = std::async(std::launch::async, read);
}

void SceneEditor::send(bool isGesture) {
    if (selection_ && findObject(document_->scene(), *selection_) == nullptr) selection_.reset();
    std::vector<scene::SceneEdit> edits = document_->takeJournal();
    if (edits.empty()) return;
    edits_ = session_.edit(std::move(edits), isGesture);
    if (std::exchange(sentStructure_, document_->structure()) != document_->structure()) structureEdits_ = edits_;
}

void SceneEditor::perform(std::string name, std::vector<scene::SceneEdit> edits, std::uint64_t gesture) {
    document_->perform(std::move(name), std::move(edits), gesture);
    send(gesture != 0);
}

void SceneEditor::performAnew(std::string name, const MakeEdit& make, std::uint64_t gesture) {
    document_->giveUp(gesture);
    try {
        document_->perform(std::move(name), {make(document_->scene())}, gesture);
    } catch (...) {
        send(true);
        throw;
    }
    send(true);
}

void SceneEditor::giveUp(std::uint64_t gesture) {
    document_->giveUp(gesture);
    send(false);
}

void SceneEditor::undo() {
    document_->undo();
    send(false);
}

void SceneEditor::redo() {
    document_->redo();
    send(false);
}

void SceneEditor::save(const std::string& file) {
    if (saving_.valid()) return;
    const auto write = [scene = document_->scene(), file] {
        writeText(file, scene::toJson(scene));
        return file;
    };
    saving_ = std::async(std::launch::async, write);
    document_->markSaved(); // unless it fails
}

bool SceneEditor::isInStep(const SessionState& state) const {
    return document_ && state.scene && state.sceneEdits >= structureEdits_;
}

void SceneEditor::select(std::optional<scene::ObjectPath> path) {
    if (path && findObject(document_->scene(), *path) == nullptr) path.reset();
    selection_ = std::move(path);
}

std::optional<scene::Bounds> SceneEditor::selectionBounds(const SessionState& state) {
    if (!selection_ || !isInStep(state)) return std::nullopt;
    if (measured_.scene != state.scene || measured_.path != *selection_) {
        measured_ = {state.scene, *selection_, std::nullopt};
        const scene::LeafRange leaves = leavesOf(document_->scene(), *selection_);
        const scene::Bounds bounds = boundsOfObjects(*state.scene, leaves.first, leaves.count);
        if (!bounds.empty()) measured_.bounds = bounds;
    }
    return measured_.bounds;
}

} // namespace rt::app
