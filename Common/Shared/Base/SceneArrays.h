// The arrays of a scene, each declared once. From these rows follow the compiled scene's members and its hash, the
// CPU's view, the GPU's buffers and their addresses, and what fetches an element. A row:
//     (type of an element, name, function that fetches, what errors call the array)
// Functions of PLAIN rows return element i; those of OWN rows do more, and each engine defines them.
#ifndef RT_SHARED_SCENE_ARRAYS_H
#define RT_SHARED_SCENE_ARRAYS_H

// What a scene consists of, and what its hash is made of. Arrays of what it does not use are empty.
// clang-format off
#define RT_SCENE_SOURCE_ARRAYS(PLAIN, OWN) \
    PLAIN(Sphere, spheres, loadSphere, "spheres") \
    OWN(vec3, sphereMotions, loadSphereMotion, "motion") /* displacement over the shutter; empty, or one a sphere */ \
    PLAIN(Quad, quads, loadQuad, "quads") \
    PLAIN(Round, rounds, loadRound, "disks and cylinders") \
    PLAIN(vec3, positions, loadPosition, "vertices") \
    PLAIN(vec3, normals, loadNormal, "normals") /* unit; see Mesh */ \
    PLAIN(vec2, uvs, loadUv, "texture coordinates") \
    PLAIN(vec4, colors, loadColor, "vertex colours") /* linear rgb, opacity */ \
    PLAIN(vec4, tangents, loadTangent, "tangents") /* unit direction of u; sign of the bitangent */ \
    PLAIN(uvec3, triangles, loadTriangle, "triangles") /* into positions; along a space-filling curve per mesh */ \
    PLAIN(Mesh, meshes, loadMesh, "meshes") \
    PLAIN(Geometry, geometries, loadGeometry, "geometries") \
    PLAIN(Instance, instances, loadInstance, "instances") \
    PLAIN(Material, materials, loadMaterial, "materials") \
    PLAIN(Principled, principled, loadPrincipled, "materials") /* empty, or one a material */ \
    PLAIN(Texture, textures, loadTexture, "textures") \
    PLAIN(Image, images, loadImage, "images") \
    OWN(uint, texels, loadTexel, "texels") /* words of all images */ \
    PLAIN(vec3, perlinGradients, loadPerlinGradient, "noise") /* kPerlinSize a table */ \
    PLAIN(uint, perlinPermutations, loadPerlinPermutation, "noise") /* 3 kPerlinSize a table: x, y, z */ \
    PLAIN(Medium, media, loadMedium, "media") \
    PLAIN(Light, lights, loadLight, "lights") /* lights, then importance targets */ \
    PLAIN(float, skyCdf, loadSkyCdf, "sky") /* sky image: of rows (height + 1), then of columns in each (width + 1) */

// What follows from them.
#define RT_SCENE_DERIVED_ARRAYS(PLAIN, OWN) \
    PLAIN(vec3, directionalAlbedos, loadDirectionalAlbedo, "materials") /* see PrincipledAlbedos.h; empty without */ \
    PLAIN(vec2, stretchedAlbedos, loadStretchedAlbedo, "materials") /* of anisotropic ones; PrincipledAlbedos.h */ \
    PLAIN(float, glassAlbedos, loadGlassAlbedo, "materials") /* of each index of refraction; PrincipledAlbedos.h */ \
    PLAIN(uint, triangleMesh, loadTriangleMesh, "triangles") /* mesh of each triangle */ \
    PLAIN(SpecularCaster, specularCasters, loadSpecularCaster, "connections") /* kConnectedSpheres at most */ \
    PLAIN(CasterLight, casterLights, loadCasterLight, "connections") /* of each of them, see SpecularCaster */ \
    PLAIN(SkyPatch, skyPatches, loadSkyPatch, "connections") /* apart from each other */ \
    OWN(LightBound, lightBounds, loadLightBound, "lights") /* one for each light */ \
    OWN(LightNode, lightNodes, loadLightCluster, "the light tree") /* over more than kContributionLights lights */ \
    /* node * kLightNodeChildren + child, or kNone: of each of those lights, then of each node, in its parent */ \
    PLAIN(uint, lightToLeaf, loadLightLeaf, "the light tree")
// clang-format on

#define RT_SCENE_ARRAYS(PLAIN, OWN) RT_SCENE_SOURCE_ARRAYS(PLAIN, OWN) RT_SCENE_DERIVED_ARRAYS(PLAIN, OWN)

#endif
