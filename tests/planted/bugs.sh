# The bugs that run.sh plants: name, file, extended regular expression for sed, and the test that must see it. Each is a mistake
# that could be made, in a line that rarely changes.

# ---- random numbers and samplers -------------------------------------------------------------------------------------
bug 'a uniform number of 1' Random.h 's/return float\(x >> 8u\) \* 5\.9604644775390625e-8f/return float(x >> 8u) * 5.9604652e-8f/' unit.Uniform
bug 'second Sobol coordinate' Random.h 's/(0xf0f0f0f0u\) >> )4u/\13u/' unit.Sobol
bug 'Owen scrambling that is not nested' Random.h 's/0x05526c56u/0x05526c57u/' unit.Sobol
bug 'cosine hemisphere' Sampling.h 's/sqrt\(\(1\.0f - d\.z\) \* \(1\.0f \+ d\.z\)\)/1.0f - d.z/' unit.Sampling
bug 'points on a sphere' Sampling.h 's/float z = 1\.0f - 2\.0f \* u\.x/float z = 1.0f - 1.98f * u.x/' unit.Sampling

# ---- lights ----------------------------------------------------------------------------------------------------------
bug 'density inside a sphere light' SphereLight.h 's/max\(dot\(normal, wi\), 0\.0f\) \* kInvPi : 0\.25f/max(dot(normal, wi), 0.0f) * 0.9f * kInvPi : 0.25f/' cross.Families/Samplers
bug 'density inside an ellipsoid light' EllipsoidLight.h 's/max\(dot\(normal, wi\), 0\.0f\) \* kInvPi : 0\.25f/max(dot(normal, wi), 0.0f) * 0.9f * kInvPi : 0.25f/' unit.Ellipsoids
bug 'weight of corners of a quad light' QuadLight.h 's/s\.pdf \*= bilinearDensity\(cosines, numbers\);//' unit.Lights/LightCase
bug 'density on a triangle light' TriangleLight.h 's/s\.pdf = 1\.0f \/ t\.solidAngle;/s.pdf = 0.9f \/ t.solidAngle;/' unit.Lights/LightCase
bug 'contribution of a light near the horizon' LightContribution.h 's/above \/ \(4\.0f \* wide\)/above \/ (3.9f * wide)/' cross.Families/Samplers
bug 'probability of a light chosen uniformly' LightSelection.h 's/choice\.probability = 1\.0f \/ float\(count\);/choice.probability = 1.0f \/ float(count + 1u);/' cross.Families/Samplers
bug 'weight of a punctual light' DirectLight.h 's/isPunctualSample \? 0\.0f : scattering/isPunctualSample ? f.w : scattering/' image.Irradiance
bug 'flux of a spot' LightTable.cpp 's/\(outer - inner\) \/ 3\)/(outer - inner) \/ 2)/' unit.PunctualLight
bug 'a sky that turns the other way' Sky.h 's/turn\.x \* d\.x \+ turn\.y \* d\.z/turn.x * d.x - turn.y * d.z/' unit.Sky

# ---- paths -----------------------------------------------------------------------------------------------------------
bug 'weight of multiple importance sampling' Sampling.h 's/square\(pdfB \/ pdfA\)/pdfB \/ pdfA/' image.Irradiance
bug 'Russian roulette without its weight' PathStep.h 's/s\.throughput \/= probability;//' image.Furnace
bug 'the side on which light reflected inside glass comes back' ConnectionChain.h 's/ \|\| side \* dot\(moment/ || dot(moment/' unit.Connection
bug 'weight of rays in a part of a pixel' EdgeRays.h 's/part\.size\.x \* part\.size\.y/part.size.x/' image.EdgeRays
bug 'light in a glossy mirror counted twice' EdgeRayPaths.h 's/return kEmissionApartBehindGlossy;/return kEmissionWeighed;/' image.EdgeRays
bug 'direct light through a medium' DirectLight.h 's/return transmittance\(depth\);/return transmittance(0.5f * depth);/' image.Transmittance

bug 'a shutter that does not open' ShutterEngine.cpp 's/share \* \(close_ - open_\)/0.5 * (close_ - open_)/' image.Shutter
bug 'replicates that share their times' ShutterEngine.cpp 's/hash3\(\{seed, replicate, kTimeKey/hash3({seed, 0u, kTimeKey/' image.Shutter
bug 'replicates of one seed' ShutterEngine.cpp 's/settings\.seed = shared::hash3\(\{settings_\.seed, replicate, kSeedKey\}\)\.x/settings.seed = settings_.seed/' image.Shutter
bug 'poses whose times leave a part of the shutter out' ShutterEngine.cpp 's/kDimensionTime\)\.x \* 0x1p-32/kDimensionTime).x * 0x1p-33/' unit.ShutterPoses

# ---- materials, media, textures --------------------------------------------------------------------------------------
bug 'density of rough metal' Metal.h 's/\(square\(cosine\) \+ square\(root\)\) \/ \(2\.0f/(square(cosine)) \/ (2.0f/' unit.Fuzz/MetalFuzz
bug 'Fresnel reflectance' Dielectric.h 's/float parallel = \(c - eta \* t\)/float parallel = (c - t)/' unit.Dielectric
bug 'free flight' Media.h 's/-log1p\(-u\) \/ extinction/u \/ extinction/' unit.FreeFlight
bug 'half a texel' Textures.h 's/float at = p - 0\.5f;/float at = p;/' unit.Textures

# ---- acceleration structures -----------------------------------------------------------------------------------------
bug 'box of a sphere' PrimitiveBoxes.cpp 's/box\.upper \+= vec3\(sphere\.radius\)/box.upper += vec3(0.5f * sphere.radius)/' unit.AccelOracle
bug 'hits behind the nearest' TraverseNodes.h 's/lanes\.mask & \(lanes\.t <= broadcast\(best\.t\)\)/lanes.mask/' unit.AccelOracle
bug 'boxes of the GPU that are left early' TraverseTree.glsl 's/leave = min\(leave, middle \+ reach\);/leave = min(leave, (middle + reach) * 0.97f);/' cross.Scenes/AgreementTest

# ---- film and images -------------------------------------------------------------------------------------------------
bug 'checkpoint without squares' FilmState.cpp 's/writer\.put\(std::span\(squares_\)\);//' unit.FilmCheckpoint
bug 'a film on the device that loses low words' FilmReduce.comp 's/precise vec3 rest = s\.low \+ error;/precise vec3 rest = error;/' cross.DeviceFilmTest
bug 'samples of a plan that all have one number' SampleList.comp 's/plannedAt\(launch\.film, start, step\)/plannedAt(launch.film, start, 0u)/' cross.SharedOrNot/SampleListTest
bug 'relMSE' Metrics.cpp 's/\(square\(target\) \+ kRelativeFloor\)/(std::abs(target) + kRelativeFloor)/' unit.Metrics
bug 'an EXR whose table leads beside its rows' ExrWriter.cpp 's/kRowHead = 8/kRowHead = 4/' unit.ImageExr
bug 'EXR attributes of any size' ExrHeader.cpp 's/fixed->bytes == size/fixed != nullptr/' unit.ImageIoHostile

# ---- denoiser --------------------------------------------------------------------------------------------------------
bug 'weights from the half that is filtered' DenoiseFilter.cpp 's/halves_\.half\[1 - half\]/halves_.half[half]/' unit.Denoiser
bug 'pixels that are compared as if they had no noise' Denoiser.cpp 's/\+= 0\.5f \* difference \* difference/+= 0.0f * difference/' unit.Denoiser
bug 'no stop at an edge' DenoiseWeights.h 's/0\.125f \* perSquaredBandwidth/0.0f * perSquaredBandwidth/' unit.Denoiser
bug 'an error without what is left of the noise' DenoiseWeights.h 's/a\.ownFactor \+ b\.ownFactor - 1\.0f/-1.0f/' unit.Denoiser
bug 'features that know the noise of the picture' PathKernel.h 's/kFeatureReplicate, samples\.x\)/0u, samples.x)/' image.CpuEngine
bug 'noise of one half that is given back' DenoiseMix.h 's/ - denoiseMixCorrection\(a, b\)//' unit.DenoiseMix
bug 'errors of a filter by pixels of any surface' DenoiseFilter.cpp 's/likeness\[x\] = shared::denoiseLikeness\(likeness\[x\]\)/likeness[x] = 1.0f/' unit.Denoiser
bug 'quiet pixels that get back what noisy ones do' DenoiseMix.h 's/kPerLogarithm = 0\.72134752f/kPerLogarithm = 0.0f/' unit.DenoiseMix
bug 'likeness on the device without a part of the normal' DenoiseErrors.comp 's/launch\.surfaces\.at\[at\]/0.0f * &/' cross.DeviceDenoiserTest
bug 'noise that is given back as error' DenoiseMix.h 's/residual \* residual - noise/residual * residual/' unit.DenoiseMix
bug 'live weights from the half that is filtered' LiveDenoiser.cpp 's/levels_\[0\]\[1 - half\]\.radiance/levels_[0][half].radiance/' unit.LiveDenoiser
bug 'weights of the device from the half that is filtered' DenoiseDistances.glsl 's/ivec2\(column, 0\), 1 - half_/ivec2(column, 0), half_/' cross.DeviceDenoiserTest
bug 'rows of a fit that end alike' DenoiseFit.comp 's/float\(2 \* y \+ 1\)/float(2 * y)/' cross.DeviceDenoiserTest
bug 'features of the device without their mean' DenoiseFeatures.comp 's/values\[k\] -= mean\[k\];/values[k] -= 0.0f;/' cross.DeviceDenoiserTest
bug 'live quality by the weights of its own half' DenoiseLivePrepare.comp 's/\(1u - half_\) \* pixels/half_ * pixels/' cross.DeviceDenoiserTest

# ---- options, scenes -------------------------------------------------------------------------------------------------
bug 'a whole number beyond its range' OptionValues.cpp 's/rest != end \|\| value < min \|\| value > max/rest != end || value < min/' unit.OptionsTest
bug 'a key twice in a configuration' ConfigText.cpp 's/same\); first != entries_\.end\(\)\)/same); first == entries_.end() - 1)/' unit.ConfigTextTest
bug 'a scene file without the field "light"' SceneWriter.cpp 's/setUnless\(out, "light", surface\.light, true\);//' unit.SceneJson
bug 'a scale of 0' ObjectReader.cpp 's/factors\.x == 0 \|\| factors\.y == 0 \|\| factors\.z == 0/factors.x == 1e300/' unit.SceneJson
bug 'defocus in a scene file' SceneWriter.cpp 's/\{"defocus_angle", camera\.defocusAngle\}/{"defocus_angle", camera.focusDistance}/' unit.All/BuiltinScenes

# ---- windows, history, benchmark -------------------------------------------------------------------------------------
bug 'a window that is not drawn again when it is uncovered' App.cpp 's/ \|\| isExposed \|\|/ ||/' gui.PictureTest
bug 'the key that opens a file' Shortcuts.cpp 's/GLFW_KEY_O, When::Control, \[\]/GLFW_KEY_P, When::Control, []/' gui.WindowFilesTest
bug 'the curve of a run' RunHistory.cpp 's/curve\.push_back\(\{point\.seconds, point\.relmse\}\)/curve.push_back({point.relmse, point.seconds})/' unit.RunHistoryTest
bug 'uncertainty of two errors' Efficiency.cpp 's/hypot\(relativeCi\(\*match\.best, pixels\), /hypot(0.0, /' unit.BenchEfficiency

# ---- shape of the code -----------------------------------------------------------------------------------------------
bug 'shaders lose the branch that is taken' ReachedCode.cpp 's/branch\.onFalse \? 0 : 1/branch.onFalse ? 1 : 0/' cross.ShaderPruning
bug 'a shader group that no scene needs' RtPipeline.cpp 's/name \+= "\+quads";/list.addTriangles(Shader::QuadHit); &/' cross.ShaderGroupsTest
bug 'a shared header that needs another one' Media.h 's/#include "Common\/Shared\/Base\/Sampling\.h"//' structure.sharedHeaders.g++
bug 'an include against the arrows' Film.cpp '1s/$/\n#include "Common\/App\/Platform.h"/' structure.IncludeRules
