// The scene of a window as it is edited: its description with its history, what is selected, and the files that it is
// read from and saved to. All of it is of the window's thread; the session gets each edit, for a description of its
// own.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/Autosave.h"
#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/App/Interactive/ObjectSelection.h"
#include "Common/Scene/Edit/SceneDocument.h"
#include "Common/Scene/Moment.h"

namespace rt::app {

// What is selected, as it is marked in the picture.
struct SelectionOutline {
    std::vector<scene::Bounds> boxes; // of each object that has an extent in the picture's scene
    std::vector<glm::dvec3> lights;   // where those without extent stand
    scene::Bounds all;                // of both
};

class SceneEditor {
  public:
    // `assetsBelow`: as --assets-below. `autosave` outlives it and gets what is not saved; null: nobody does.
    SceneEditor(InteractiveSession& session, std::string assetsBelow, Autosave* autosave = nullptr)
        : session_(session), assetsBelow_(std::move(assetsBelow)), autosave_(autosave) {}
    ~SceneEditor();
    SceneEditor(const SceneEditor&) = delete;
    SceneEditor& operator=(const SceneEditor&) = delete;

    // Each frame: another scene ends the editing of the one before. Throws, once, what has kept the description from
    // being read or saved.
    void follow(const SessionState& state);
    // Begins to read the description once more, unless it is there or on its way: what is rendered tells no names.
    void begin();
    // Not while it is on: other poses of a scene that moves come before the description would be there.
    void rest(bool isOn) { isResting_ = isOn; }
    bool isReading() const { return reading_.valid(); }

    // Null until it is there.
    const scene::SceneDocument* document() const { return document_ ? &*document_ : nullptr; }
    // As SceneDocument::perform(), throwing what that does. Requires a document, as do those that follow.
    void perform(std::string name, std::vector<scene::SceneEdit> edits, std::uint64_t gesture = 0);
    // In place of what the gesture has done so far: edits of the scene as it was before that.
    using MakeEdits = std::function<std::vector<scene::SceneEdit>(const scene::SceneDesc&)>;
    void performAnew(std::string name, const MakeEdits& make, std::uint64_t gesture);
    void giveUp(std::uint64_t gesture);
    void joinSteps(std::string name); // as SceneDocument has it
    void undo();
    void redo();
    std::uint64_t newGesture() { return ++gestures_; }
    // Does again what an autosave holds, to the scene as it was before that. Throws where it does not fit the scene,
    // with what has been done until then.
    void repeat(std::vector<scene::EditStep> steps);

    bool isDirty() const { return document_ && (document_->isDirty() || isSaving()); } // until all of it is written
    // All that is dirty is on its way to the file.
    bool isDirtyUntilSaved() const { return isSaving() && document_ && !document_->isDirty(); }
    // As a scene file; what is edited is in that file from then on.
    void save(const std::string& file);
    bool isSaving() const { return saving_.valid(); }
    // Of what this has written, which need not be read again; none yet.
    const std::optional<FileFingerprint>& savedMark() const { return savedMark_; }
    std::optional<std::string> takeSaved() { return std::exchange(saved_, std::nullopt); } // once: the file

    // Whether the picture shows the objects that the description has, in that order: then what is seen can be named.
    bool isInStep(const SessionState& state) const;
    // Whether the picture's scene has all edits.
    bool isUpToDate(const SessionState& state) const { return document_ && state.scene && state.sceneEdits >= edits_; }
    // Objects that exist. They stay selected wherever edits lead them.
    const ObjectSelection& selected() const { return selected_; }
    const std::optional<scene::ObjectPath>& selection() const { return selected_.active(); } // the latest of them
    void select(std::optional<scene::ObjectPath> path);
    void select(std::vector<scene::ObjectPath> paths, const scene::ObjectPath& active);
    void toggle(const scene::ObjectPath& path); // as ObjectSelection has it
    const SelectionOutline& outline(const SessionState& state);

  private:
    using Read = std::pair<scene::SceneDesc, scene::SceneDesc>; // for the window, for the session
    void followJournal();
    void send(bool isGesture);
    void end();
    void takeBack(std::uint64_t gesture); // without telling anybody
    void note(scene::EditStep step);
    void keepNotes();
    void beginAutosave(const std::string& source, const scene::Moment& moment, std::optional<FileFingerprint> mark);
    void finishSaving();

    InteractiveSession& session_;
    const std::string assetsBelow_;
    Autosave* const autosave_;
    std::vector<scene::EditStep> notes_;      // what has just been done, for the autosave
    std::vector<scene::EditStep> sinceSaved_; // while it is being saved: what its file will lack
    std::size_t keptFrom_ = 0;                // the history's position that the autosave begins at
    bool keepsEdits_ = false;                 // no steps, as those would lead to what it does not know
    std::optional<FileFingerprint> readMark_; // of the file that is being read
    bool isResting_ = false;
    std::string source_;           // of the scene that there is
    scene::Moment moment_;         // that it is posed at
    std::uint64_t sceneReads_ = 0; // that this has followed
    std::optional<scene::SceneDocument> document_;
    ObjectSelection selected_;
    std::uint64_t gestures_ = 0;
    std::uint64_t edits_ = 0;                    // that the session has been sent
    std::uint64_t structureEdits_ = 0;           // of those, the last one that changed which objects there are
    std::uint64_t sentStructure_ = 0;            // of the document, as it was then
    std::shared_ptr<std::atomic<bool>> callOff_; // what is being read
    std::future<Read> reading_;
    std::future<std::string> saving_;
    std::optional<std::string> saved_;
    std::optional<FileFingerprint> savedMark_;
    std::vector<scene::SceneEdit> journal_; // that the selection has followed and the session has not been sent
    struct Outlined {                       // of what outline_ is
        std::shared_ptr<const scene::CompiledScene> scene;
        std::uint64_t selection = 0, revision = 0;
        bool operator==(const Outlined&) const = default;
    } outlined_;
    SelectionOutline outline_;
};

} // namespace rt::app
