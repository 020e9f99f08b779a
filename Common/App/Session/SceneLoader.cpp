#include "Common/App/Session/SceneLoader.h"

#include <filesystem>
#include <iterator>
#include <utility>

#include "Common/App/Platform.h"
#include "Common/Core/Interruption.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {
namespace {

// Whether both are of one scene that is edited, at whatever time.
bool areOfOneEdit(const SceneRequest& a, SceneRequest b) {
    if (a.edits == 0 || b.edits == 0) return false;
    b.edits = a.edits;
    return a == b;
}

// Whether both are of one scene that moves, at whatever moments.
bool areOfOneMotion(const SceneRequest& a, SceneRequest b) {
    if (a.poses == 0 || b.poses == 0 || a.edits > 0) return false;
    b.poses = a.poses;
    b.moment = a.moment;
    b.shutter = a.shutter;
    return a == b;
}

bool areOfOneScene(const SceneRequest& a, const SceneRequest& b) {
    return areOfOneEdit(a, b) || areOfOneMotion(a, b);
}

} // namespace

// The file is read again by whoever opens it; to be posed it is read once.
void SceneLoader::loadPose(const SceneRequest& request, LoadedScene& result) {
    if (request.poses == 0 || (posed_ && !posed_->isOf(request))) posed_.reset();
    if (!posed_) posed_ = std::make_shared<PosedScene>(request);
    result.mark = posed_->mark();
    if (!posed_->isAnimated()) posed_.reset();
    const bool isBlurred = posed_ && request.shutter.isOpen();
    if (isBlurred) {
        const scene::Moment moment = wholeMoment(request);
        result.poses = posesOf(posed_, moment);
        result.scene = result.poses(moment.time + request.shutter.middle());
    } else {
        result.scene = posed_ ? posed_->at(request.moment) : compile(request);
    }
}

LoadedScene SceneLoader::load(const SceneRequest& request) {
    const Interruptible interruptible(callOff_);
    LoadedScene result;
    result.request = request;
    result.mark = markOf(request.source);
    const auto begin = std::filesystem::file_time_type::clock::now();
    const Stopwatch watch;
    try {
        if (request.edits > 0)
            result.scene = compileKept(*description_, request, &memory_);
        else if (request.poses > 0 || request.shutter.isOpen())
            loadPose(request, result);
        else
            posed_.reset(), result.scene = compile(request);
    } catch (...) {
        result.failure = std::current_exception();
    }
    result.seconds = watch.seconds();
    if (result.scene) result.models = marksOfRead(result.scene->modelFiles, begin);
    return result;
}

SceneLoader::SceneLoader(std::function<void(LoadedScene)> onLoaded)
    : onLoaded_(std::move(onLoaded)), thread_([this] { work(); }) {}

SceneLoader::~SceneLoader() {
    {
        const std::scoped_lock lock(mutex_);
        quit_ = callOff_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void SceneLoader::request(SceneRequest request) {
    {
        const std::scoped_lock lock(mutex_);
        ask(std::move(request));
        callOff_ = true;
    }
    wake_.notify_one();
}

void SceneLoader::ask(SceneRequest request) {
    last_ = request;
    next_ = std::move(request);
    isGivenUp_ = false;
}

void SceneLoader::startEditing(scene::SceneDesc scene) {
    {
        const std::scoped_lock lock(mutex_);
        edited_ = handedOver_;
        nextDescription_ = std::move(scene);
        nextEdits_.clear();
        if (isPreparing_) callOff_ = true;
    }
    wake_.notify_one();
}

void SceneLoader::stopEditing() {
    const std::scoped_lock lock(mutex_);
    nextDescription_.reset();
    nextEdits_.clear();
    if (isPreparing_) callOff_ = true;
    forgetsDescription_ = current_ || isPreparing_;
    if (!forgetsDescription_) forgetDescription(); // the thread rests
}

std::uint64_t SceneLoader::edit(std::vector<scene::SceneEdit> edits, bool isGesture) {
    std::uint64_t number = 0;
    {
        const std::scoped_lock lock(mutex_);
        std::move(edits.begin(), edits.end(), std::back_inserter(nextEdits_));
        const bool goesOn = isPreparing_ || (isGesture && current_ && current_->edits > 0);
        edited_.edits = number = ++edits_;
        ask(edited_);
        if (!goesOn) callOff_ = true;
    }
    wake_.notify_one();
    return number;
}

std::uint64_t SceneLoader::pose(const scene::Moment& moment, const scene::Shutter& shutter) {
    std::uint64_t number = 0;
    {
        const std::scoped_lock lock(mutex_);
        SceneRequest request = last_;
        request.moment = moment;
        request.shutter = shutter;
        request.edits = 0;
        request.poses = number = ++poses_;
        if (!(current_ && areOfOneMotion(*current_, request))) callOff_ = true;
        ask(std::move(request));
    }
    wake_.notify_one();
    return number;
}

void SceneLoader::rename(const std::string& source) {
    {
        const std::scoped_lock lock(mutex_);
        const bool isBusy = next_ || current_;
        edited_.source = source;
        edited_.moment = {};
        if (last_.edits == 0) return; // another one has been asked for
        last_.source = handedOver_.source = source;
        last_.moment = handedOver_.moment = {}; // which that file is written at
        if (isBusy) ask(last_);
    }
    wake_.notify_one();
}

void SceneLoader::giveUp() {
    const std::scoped_lock lock(mutex_);
    if (next_ || current_) last_ = handedOver_;
    next_.reset();
    isGivenUp_ = callOff_ = true;
}

bool SceneLoader::isWanted(const SceneRequest& request) const {
    const std::scoped_lock lock(mutex_);
    return !isGivenUp_ && (request == last_ || areOfOneScene(request, last_));
}

void SceneLoader::open(const std::string& source, std::optional<scene::Moment> moment) {
    const SceneRequest last = lastRequest();
    const bool isAgain = source == last.source; // the file has changed
    if (!moment) moment = isAgain ? last.moment : scene::Moment();
    request({source, last.oneSidedLights, {}, last.assetsBelow, *moment, isAgain ? last.shutter : scene::Shutter()});
}

bool SceneLoader::setOneSidedLights(bool on) {
    SceneRequest last = lastRequest();
    if (last.oneSidedLights == on) return false;
    last.oneSidedLights = on;
    {
        const std::scoped_lock lock(mutex_);
        edited_.oneSidedLights = on;
    }
    request(std::move(last));
    return true;
}

SceneRequest SceneLoader::lastRequest() const {
    const std::scoped_lock lock(mutex_);
    return last_;
}

bool SceneLoader::isResting() const {
    const std::scoped_lock lock(mutex_);
    return !next_ && !current_ && !nextDescription_ && !isPreparing_;
}

std::optional<std::string> SceneLoader::busyWith() const {
    const std::scoped_lock lock(mutex_);
    if (next_) return next_->source;
    if (current_ && !isGivenUp_) return current_->source;
    return std::nullopt;
}

void SceneLoader::forgetDescription() {
    description_.reset();
    memory_ = {};
    doneEdits_.clear();
}

// Compiles what is shown, to know its surfaces by the meshes of the description. The memory keeps the scene that there
// is: another one like it would be of no use.
void SceneLoader::prepareEdits(const SceneRequest& request, const std::weak_ptr<const scene::CompiledScene>& shown) {
    const Interruptible interruptible(callOff_);
    try {
        const std::uint64_t hash = compileKept(*description_, request, &memory_)->hash;
        memory_.scene = shown.lock();
        if (memory_.scene && memory_.scene->hash == hash) return;
    } catch (...) { // which the first edit will tell
    }
    memory_ = {};
}

void SceneLoader::work() {
    lowerThreadPriority();
    std::unique_lock lock(mutex_);
    while (true) {
        if (std::exchange(forgetsDescription_, false)) forgetDescription();
        wake_.wait(lock, [this] { return quit_ || next_ || nextDescription_; });
        if (quit_) return;
        callOff_ = false;
        if (nextDescription_) {
            forgetDescription();
            description_ = std::exchange(nextDescription_, std::nullopt);
        }
        if (!next_) {
            isPreparing_ = true;
            const SceneRequest asShown = edited_;
            const auto shown = shown_;
            lock.unlock();
            prepareEdits(asShown, shown);
            lock.lock();
            isPreparing_ = false;
            continue;
        }
        current_ = std::exchange(next_, std::nullopt);
        const SceneRequest request = *current_;
        std::vector<scene::SceneEdit> edits = std::exchange(nextEdits_, {});
        lock.unlock();
        for (scene::SceneEdit& edit : edits) {
            scene::exchange(*description_, edit);
            doneEdits_.push_back(std::move(edit));
        }
        LoadedScene loaded = load(request);
        if (loaded.scene) doneEdits_.clear();
        lock.lock();
        const bool isEarlier = next_ && !callOff_ && loaded.scene && areOfOneScene(request, *next_);
        const bool wanted = !quit_ && !isGivenUp_ && (!next_ || isEarlier);
        if (wanted) {
            handedOver_ = request;
            if (loaded.scene) shown_ = loaded.scene;
            lock.unlock();
            onLoaded_(std::move(loaded));
            lock.lock();
        }
        current_.reset();
    }
}

} // namespace rt::app
