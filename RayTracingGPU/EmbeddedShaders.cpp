#include "RayTracingGPU/EmbeddedShaders.h"

namespace {

using std::uint32_t; // the generated headers say uint32_t

#include <Aov.Query.comp.h>
#include <Aov.comp.h>
#include <Aov.rgen.h>
#include <Cost.HeavyFeatures.Query.Time.comp.h>
#include <Cost.HeavyFeatures.Query.comp.h>
#include <Cost.HeavyFeatures.Time.comp.h>
#include <Cost.HeavyFeatures.Time.rgen.h>
#include <Cost.HeavyFeatures.comp.h>
#include <Cost.HeavyFeatures.rgen.h>
#include <Cost.Query.Time.comp.h>
#include <Cost.Query.comp.h>
#include <Cost.Time.comp.h>
#include <Cost.Time.rgen.h>
#include <Cost.comp.h>
#include <Cost.rgen.h>
#include <FilmReduce.comp.h>
#include <FilmResolve.comp.h>
#include <PathReuse.Query.comp.h>
#include <PathReuse.comp.h>
#include <PathReuse.rgen.h>
#include <PathTrace.HeavyFeatures.Query.comp.h>
#include <PathTrace.HeavyFeatures.comp.h>
#include <PathTrace.Query.comp.h>
#include <PathTrace.comp.h>
#include <Preview.comp.h>
#include <Preview.frag.h>
#include <Preview.vert.h>
#include <RayTracing.HeavyFeatures.rgen.h>
#include <RayTracing.Procedural.rchit.h>
#include <RayTracing.Procedural.rint.h>
#include <RayTracing.Quad.rchit.h>
#include <RayTracing.rchit.h>
#include <RayTracing.rgen.h>
#include <RayTracing.rmiss.h>
#include <SampleList.comp.h>

} // namespace

namespace rt::gpu {

std::span<const std::uint32_t> shaderCode(Shader shader) {
    switch (shader) {
        case Shader::PathCompute:
            return PathTrace_comp;
        case Shader::PathQuery:
            return PathTrace_Query_comp;
        case Shader::HeavyPathCompute:
            return PathTrace_HeavyFeatures_comp;
        case Shader::HeavyPathQuery:
            return PathTrace_HeavyFeatures_Query_comp;
        case Shader::ReuseCompute:
            return PathReuse_comp;
        case Shader::ReuseQuery:
            return PathReuse_Query_comp;
        case Shader::AovCompute:
            return Aov_comp;
        case Shader::AovQuery:
            return Aov_Query_comp;
        case Shader::CostCompute:
            return Cost_comp;
        case Shader::CostQuery:
            return Cost_Query_comp;
        case Shader::HeavyCostCompute:
            return Cost_HeavyFeatures_comp;
        case Shader::HeavyCostQuery:
            return Cost_HeavyFeatures_Query_comp;
        case Shader::TimeCompute:
            return Cost_Time_comp;
        case Shader::TimeQuery:
            return Cost_Query_Time_comp;
        case Shader::HeavyTimeCompute:
            return Cost_HeavyFeatures_Time_comp;
        case Shader::HeavyTimeQuery:
            return Cost_HeavyFeatures_Query_Time_comp;
        case Shader::RayGeneration:
            return RayTracing_rgen;
        case Shader::HeavyRayGeneration:
            return RayTracing_HeavyFeatures_rgen;
        case Shader::ReuseGeneration:
            return PathReuse_rgen;
        case Shader::AovGeneration:
            return Aov_rgen;
        case Shader::CostGeneration:
            return Cost_rgen;
        case Shader::HeavyCostGeneration:
            return Cost_HeavyFeatures_rgen;
        case Shader::TimeGeneration:
            return Cost_Time_rgen;
        case Shader::HeavyTimeGeneration:
            return Cost_HeavyFeatures_Time_rgen;
        case Shader::Miss:
            return RayTracing_rmiss;
        case Shader::TriangleHit:
            return RayTracing_rchit;
        case Shader::QuadHit:
            return RayTracing_Quad_rchit;
        case Shader::SphereHit:
            return RayTracing_Procedural_rchit;
        case Shader::SphereIntersection:
            return RayTracing_Procedural_rint;
        case Shader::FilmReduce:
            return FilmReduce_comp;
        case Shader::SampleList:
            return SampleList_comp;
        case Shader::FilmResolve:
            return FilmResolve_comp;
        case Shader::PreviewVertex:
            return Preview_vert;
        case Shader::PreviewFragment:
            return Preview_frag;
        case Shader::PreviewFinish:
            return Preview_comp;
    }
    return {};
}

} // namespace rt::gpu
