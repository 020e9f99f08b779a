@echo off
rem Builds and runs on Windows with Visual Studio's tools and libraries from vcpkg. build.bat help lists the verbs.
setlocal
cd /d "%~dp0"
set verb=%1
if "%verb%"=="" set verb=build
if "%verb%"=="help" goto help

if not defined VCPKG_ROOT (
    echo build.bat: set VCPKG_ROOT to the folder of vcpkg 1>&2
    exit /b 1
)
set vcpkg=%VCPKG_ROOT%
if not defined VSCMD_VER (
    for /f "usebackq delims=" %%i in (`"%ProgramFiles(x86)%\Microsoft Visual Studio\Installer\vswhere.exe" -latest -products * -requires Microsoft.VisualStudio.Component.VC.Tools.x86.x64 -property installationPath`) do call "%%i\VC\Auxiliary\Build\vcvars64.bat" >nul
)
set configure=cmake --preset release --toolchain "%vcpkg%\scripts\buildsystems\vcpkg.cmake"
set build=cmake --build --preset release

if "%verb%"=="build" (
    %configure% && %build%
    goto end
)
if "%verb%"=="run" (
    if not exist build\run mkdir build\run
    %configure% && %build% --target ray-tracing-cpu && build\bin\ray-tracing-cpu --headless --spp 100 -o build\run\cornell-box-lights.cpu.png --stats -
    goto end
)
set tier=--label-exclude nightly
set kernels=
if "%~2"=="--all" (
    set tier=
    set kernels=-DRT_KERNELS=all
)
if "%verb%"=="test" (
    %configure% -DRT_BUILD_TESTS=ON %kernels% -DVCPKG_MANIFEST_FEATURES=tests && %build% && ctest --test-dir build --output-on-failure --no-label-summary %tier%
    goto end
)
if "%verb%"=="bench" (
    %configure% -DRT_BUILD_BENCH=ON -DVCPKG_MANIFEST_FEATURES=bench && %build% --target ray-tracing-bench && for /f "tokens=1,*" %%a in ("%*") do build\bin\ray-tracing-bench %%b
    goto end
)
echo build.bat: unknown verb '%verb%' 1>&2
call :help 1>&2
exit /b 1

:help
echo build.bat               install what is needed and build Release into build\
echo build.bat run           the same, then render the default scene and show figures
echo build.bat test          the same, then build and run the tests of every change; test --all: the nightly ones, too
echo build.bat bench [ARGS]  the same, then run ray-tracing-bench with ARGS
exit /b 0

:end
exit /b %errorlevel%
