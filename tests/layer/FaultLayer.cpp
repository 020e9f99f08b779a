// A Vulkan layer that lets calls fail as drivers and window systems let them fail, which no test could bring about
// otherwise. RT_FAULTS lists what goes wrong: "vkQueuePresentKHR:3=-4,vkAcquireNextImageKHR:9=1000001003" makes the
// third call of the one return VK_ERROR_DEVICE_LOST and the ninth of the other VK_SUBOPTIMAL_KHR. Each fault leaves a
// line on standard error. A device that was lost at vkQueueSubmit stays lost. RT_MAX_ALLOCATIONS is how many pieces of
// memory may exist at a time, as drivers have such a limit. RT_DELAYS lets calls take up to so many milliseconds more.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

std::mutex mutex;
struct Below { // the next layer
    VkInstance instance;
    PFN_vkGetInstanceProcAddr get;
};
std::map<void*, Below> instances; // by dispatch table, as are devices
struct Device {
    VkDevice device;
    PFN_vkGetDeviceProcAddr get;
};
std::map<void*, Device> devices;
std::map<std::string, int> calls; // so far
std::set<void*> lostDevices;      // by dispatch table

void* tableOf(const void* dispatchable) {
    void* table = nullptr;
    std::memcpy(&table, dispatchable, sizeof table);
    return table;
}

// Of a device, or of one of its queues, whose table is the same.
template <class Function>
Function next(const void* dispatchable, const char* name) {
    const std::scoped_lock lock(mutex);
    const Device& device = devices.at(tableOf(dispatchable));
    return reinterpret_cast<Function>(device.get(device.device, name));
}

// For up to RT_DELAYS milliseconds, so that threads meet in another order each time.
void delay() {
    const char* const maximum = std::getenv("RT_DELAYS");
    if (maximum == nullptr) return;
    thread_local std::mt19937 random{std::random_device{}()};
    std::this_thread::sleep_for(
        std::chrono::microseconds(std::uniform_int_distribution<int>(0, 1000 * std::atoi(maximum))(random)));
}

// What this call of the function is to return, if not what it does.
std::optional<VkResult> fault(const std::string& function) {
    delay();
    const std::scoped_lock lock(mutex);
    const std::string key = function + ":" + std::to_string(++calls[function]) + "=";
    const char* list = std::getenv("RT_FAULTS");
    const char* found = list != nullptr ? std::strstr(list, key.c_str()) : nullptr;
    if (found == nullptr) return std::nullopt;
    const int result = std::atoi(found + key.size());
    std::fprintf(stderr, "fault %s%d\n", key.c_str(), result);
    return static_cast<VkResult>(result);
}

VKAPI_ATTR VkResult VKAPI_CALL acquire(VkDevice device, VkSwapchainKHR swapchain, std::uint64_t timeout,
                                       VkSemaphore semaphore, VkFence fence, std::uint32_t* index) {
    const std::optional<VkResult> wrong = fault("vkAcquireNextImageKHR");
    if (wrong && *wrong < 0) return *wrong;
    const VkResult result = next<PFN_vkAcquireNextImageKHR>(device, "vkAcquireNextImageKHR")(device, swapchain, timeout,
                                                                                             semaphore, fence, index);
    return result == VK_SUCCESS ? wrong.value_or(result) : result;
}

VKAPI_ATTR VkResult VKAPI_CALL present(VkQueue queue, const VkPresentInfoKHR* info) {
    // Semaphores are waited for whatever the result.
    const VkResult result = next<PFN_vkQueuePresentKHR>(queue, "vkQueuePresentKHR")(queue, info);
    return fault("vkQueuePresentKHR").value_or(result);
}

VKAPI_ATTR VkResult VKAPI_CALL createSwapchain(VkDevice device, const VkSwapchainCreateInfoKHR* info,
                                               const VkAllocationCallbacks* allocator, VkSwapchainKHR* swapchain) {
    if (const auto wrong = fault("vkCreateSwapchainKHR")) return *wrong;
    return next<PFN_vkCreateSwapchainKHR>(device, "vkCreateSwapchainKHR")(device, info, allocator, swapchain);
}

bool isLost(const void* dispatchable) {
    const std::scoped_lock lock(mutex);
    return lostDevices.count(tableOf(dispatchable)) != 0;
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* infos, VkFence fence) {
    if (const auto wrong = fault("vkQueueSubmit")) {
        const std::scoped_lock lock(mutex);
        if (*wrong == VK_ERROR_DEVICE_LOST) lostDevices.insert(tableOf(queue));
        return *wrong;
    }
    if (isLost(queue)) return VK_ERROR_DEVICE_LOST;
    return next<PFN_vkQueueSubmit>(queue, "vkQueueSubmit")(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL waitForFences(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                                             std::uint64_t timeout) {
    delay();
    if (isLost(device)) return VK_ERROR_DEVICE_LOST; // nothing would signal them
    return next<PFN_vkWaitForFences>(device, "vkWaitForFences")(device, count, fences, all, timeout);
}

std::atomic<int> allocations{0}; // that exist

VKAPI_ATTR VkResult VKAPI_CALL allocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
    const char* maximum = std::getenv("RT_MAX_ALLOCATIONS");
    if (maximum != nullptr && allocations >= std::atoi(maximum)) return VK_ERROR_TOO_MANY_OBJECTS;
    const VkResult result = next<PFN_vkAllocateMemory>(device, "vkAllocateMemory")(device, info, allocator, memory);
    if (result == VK_SUCCESS) ++allocations;
    return result;
}

VKAPI_ATTR void VKAPI_CALL freeMemory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* allocator) {
    delay();
    if (memory != VK_NULL_HANDLE) --allocations;
    next<PFN_vkFreeMemory>(device, "vkFreeMemory")(device, memory, allocator);
}

// ---- what makes it a layer -----------------------------------------------------------------------------------------

template <class Info>
Info* link(const void* chain, VkStructureType type) {
    for (auto* info = static_cast<const Info*>(chain); info != nullptr; info = static_cast<const Info*>(info->pNext))
        if (info->sType == type && info->function == VK_LAYER_LINK_INFO) return const_cast<Info*>(info);
    return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
    auto* chain = link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr below = chain->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    chain->u.pLayerInfo = chain->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(below(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    const std::scoped_lock lock(mutex);
    if (result == VK_SUCCESS) instances[tableOf(*instance)] = {*instance, below};
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* chain = link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    const VkLayerDeviceLink& below = *chain->u.pLayerInfo;
    chain->u.pLayerInfo = below.pNext;
    const VkInstance instance = [&] {
        const std::scoped_lock lock(mutex);
        return instances.at(tableOf(physical)).instance;
    }();
    const auto create =
        reinterpret_cast<PFN_vkCreateDevice>(below.pfnNextGetInstanceProcAddr(instance, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, device);
    const std::scoped_lock lock(mutex);
    if (result == VK_SUCCESS) devices[tableOf(*device)] = {*device, below.pfnNextGetDeviceProcAddr};
    return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name);

// The function of a device that the layer has instead; null if it has none.
PFN_vkVoidFunction ownFunction(const std::string& name) {
    if (name == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    if (name == "vkAcquireNextImageKHR") return reinterpret_cast<PFN_vkVoidFunction>(acquire);
    if (name == "vkQueuePresentKHR") return reinterpret_cast<PFN_vkVoidFunction>(present);
    if (name == "vkCreateSwapchainKHR") return reinterpret_cast<PFN_vkVoidFunction>(createSwapchain);
    if (name == "vkQueueSubmit") return reinterpret_cast<PFN_vkVoidFunction>(submit);
    if (name == "vkWaitForFences") return reinterpret_cast<PFN_vkVoidFunction>(waitForFences);
    if (name == "vkAllocateMemory") return reinterpret_cast<PFN_vkVoidFunction>(allocateMemory);
    if (name == "vkFreeMemory") return reinterpret_cast<PFN_vkVoidFunction>(freeMemory);
    return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction own = ownFunction(name)) return own;
    const std::scoped_lock lock(mutex);
    return devices.at(tableOf(device)).get(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    const std::string function = name;
    if (function == "vkGetInstanceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(getInstanceProcAddr);
    if (function == "vkCreateInstance") return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
    if (function == "vkCreateDevice") return reinterpret_cast<PFN_vkVoidFunction>(createDevice);
    if (const PFN_vkVoidFunction own = ownFunction(function)) return own;
    if (instance == VK_NULL_HANDLE) return nullptr;
    const std::scoped_lock lock(mutex);
    return instances.at(tableOf(instance)).get(instance, name);
}

} // namespace

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = getInstanceProcAddr;
    version->pfnGetDeviceProcAddr = getDeviceProcAddr;
    version->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
