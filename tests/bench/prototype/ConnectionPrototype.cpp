#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>
#include <chrono>
#include "Common/Accel/CpuAccel.h"
#include "Common/App/Session/RenderParams.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Json/CameraRecord.h"
#include "Common/Shared/Texture/Color.h"
#include "RayTracingCPU/PathPacket.h"
int gAimCount=0; float gTau=0, gPre=0; rt::shared::SmoothSphere gAim[8]; rt::shared::Reach gReach[8][32]; rt::shared::vec2 gMost[8][16];
long gSolved=0,gTraced=0,gArrived=0;
namespace rt::cpu { namespace {
constexpr uint kF = kFeatureAll & ~(kFeaturePrincipled | kFeatureOpacity | kFeatureCoatNormal | kFeaturePunctualLights);
struct TracedScene {
    explicit TracedScene(const std::string& id) : compiled(app::compile(app::loadScene(id), true, true)) {
        const scene::CompiledScene& s = *compiled;
        const accel::AccelInput input{s.spheres, s.sphereMotions, s.quads, s.positions, s.triangles, s.geometries, s.instances};
        accel = accel::CpuAccel::build(input, {}, nullptr);
        view = CpuScene{viewOf(s, s.globals), accel->view(), {}};
        for (uint byte = 0; byte < 256; ++byte) linear[byte] = srgbToLinear(float(byte) / 255.0f);
        view.srgbToLinear = linear.data();
        view.tracer = accel::rayQuery().tracer(view.accel.kinds);
    }
    KernelContext context(const app::RenderSettings& settings) const {
        const Camera camera = scene::makeCamera(compiled->camera, settings.width, settings.height, compiled->origin);
        return {&view, app::makeRenderParams(*compiled, settings), camera};
    }
    std::shared_ptr<const scene::CompiledScene> compiled;
    std::unique_ptr<const accel::CpuAccel> accel;
    std::array<float, 256> linear{};
    CpuScene view;
};
std::vector<double> render(const TracedScene& scene, uint w, uint spp, uint seed) {
    app::RenderSettings settings; settings.width = settings.height = w; settings.spp = spp; settings.seed = seed;
    const KernelContext context = scene.context(settings);
    std::vector<double> img(3*w*w);
    std::vector<vec3> r(64*16);
    for (uint ty=0; ty<w; ty+=8) for (uint tx=0; tx<w; tx+=8) for (uint f=0; f<spp; f+=16) {
        TileTask task; task.x=tx; task.y=ty; task.width=std::min(8u,w-tx); task.height=std::min(8u,w-ty); task.first=f; task.count=16;
        KernelCounters c;
        PathPacket<kF>(context, task, r.data(), c).trace();
        const vec3* p=r.data();
        for (uint y=0;y<task.height;++y) for (uint x=0;x<task.width;++x) for (uint i=0;i<16;++i,++p) for (int k=0;k<3;++k) img[3*((ty+y)*w+tx+x)+k]+=double((*p)[k])/spp;
    }
    return img;
}
void measure(const TracedScene& scene, const char* name, float boost, float most) {
    gTau=boost; gPre=most; gSolved=gTraced=gArrived=0;
    const uint w=96, spp=64; const int n=6;
    std::vector<double> s(3*w*w), q(3*w*w); const auto t0=clock();
    for (int k=0;k<n;++k) { auto i=render(scene,w,spp,100+k); for (size_t j=0;j<i.size();++j){s[j]+=i[j];q[j]+=i[j]*i[j];} }
    double var=0, mean=0; for (size_t j=0;j<s.size();++j){ double m=s[j]/n; mean+=m; var+=(q[j]-n*m*m)/(n-1);} 
    std::printf("%-28s mean %.5f var %.6f  cpu %.2f  solved %ld traced %ld arrived %ld\n", name, mean/s.size(), var/s.size(), double(clock()-t0)/CLOCKS_PER_SEC, gSolved,gTraced,gArrived); std::fflush(stdout);
}
} }

namespace rt::cpu { namespace { void reaches(const TracedScene& s, bool across) {
  for (int k=0;k<gAimCount;++k) { double kyMost=0,hMost=0; for (uint l=0;l<s.compiled->globals.lightCount && l<32;++l) {
    const LightBound& b=s.compiled->lightBounds[l]; Reach& r=gReach[k][l]; const SmoothSphere& g=gAim[k];
    vec3 v=b.center-(g.center+g.motion*0.5f); float D=length(v), h = D>b.radius? std::asin(b.radius/D):1.5f; r.axis=v/D;
    r.half=vec2(std::cos(h),std::sin(h)); kyMost=std::max(kyMost, std::min(1.0, g.radius/double(std::max(D-b.radius,1e-6f)))); hMost=std::max(hMost,double(h)); (void)across;
    const Light& L=s.compiled->lights[l]; r.power = L.kind>=kLightSky && L.kind!=kLightEllipsoid ? 0.0f : luminance(L.emission)*L.area/(D*D);
  }
    for (int n=0;n<16;++n) { const double kx=std::min((n+1)/16.0,0.9999); double m=0; for(int q=1;q<=2000;++q){ const double i=M_PI/2*q/2000, sn=std::sin(i); m=std::max(m,-(2*(i-std::asin(sn/gAim[k].ior))-std::asin(kx*sn)-std::asin(kyMost*sn))); } m=std::min(m,M_PI-hMost); gMost[k][n]= m>0 ? vec2(std::cos(m),std::sin(m)) : vec2(1e3f,0.0f); }
    } } } }
int main(int argc,char**argv){ using namespace rt::cpu;
    for (int a=1;a<argc;++a){ std::printf("== %s\n",argv[a]); TracedScene s(argv[a]);
        measure(s,"off",0,0);
        for (size_t i=0;i<s.compiled->spheres.size() && gAimCount<8;++i){ const auto& sp=s.compiled->spheres[i]; const auto& m=s.compiled->materials[sp.material]; if (m.kind==kMaterialDielectric && sp.light==kNone) gAim[gAimCount++]={sp.center,sp.radius,s.compiled->sphereMotions.empty()?vec3(0):s.compiled->sphereMotions[i],m.parameter[0],m.albedo}; }
        std::printf("spheres %d lights %u\n",gAimCount,s.compiled->globals.lightCount);
        for (int ac : {1}) for (float pre : {1.0f,2.0f}) for (float tau : {0.0f,8.0f}) { reaches(s,ac); char n[64]; std::snprintf(n,64,"across %d n %g tau %g",ac,pre,tau); measure(s,n,tau,pre);} gAimCount=0;
        measure(s,"off",0,0);
    } }
