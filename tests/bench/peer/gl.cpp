#include "tests/bench/peer/gl.h"

#include <dlfcn.h>

#include <cstdlib>
#include <vector>

namespace still::peer {
namespace {

using GetProcAddress = PFNEGLGETPROCADDRESSPROC;

// ANGLE's extensions of eglGetPlatformDisplayEXT, from its eglext_angle.h.
constexpr EGLint kAnglePlatform = 0x3202, kAnglePlatformType = 0x3203;
constexpr EGLint kAngleTypeVulkan = 0x3450;
constexpr EGLint kAngleDeviceType = 0x3209, kAngleDeviceSwiftShader = 0x3487;

/// The functions of EGL, as far as a context without a surface needs them.
struct Egl {
    GetProcAddress get = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC platformDisplay = nullptr;
    PFNEGLINITIALIZEPROC initialize = nullptr;
    PFNEGLBINDAPIPROC bindApi = nullptr;
    PFNEGLCHOOSECONFIGPROC chooseConfig = nullptr;
    PFNEGLCREATECONTEXTPROC createContext = nullptr;
    PFNEGLMAKECURRENTPROC makeCurrent = nullptr;

    template <class Function>
    bool find(Function& function, const char* name) {
        function = reinterpret_cast<Function>(get(name));
        return function != nullptr;
    }
};

Result<Egl> openEgl(const std::string& library) {
    void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        return fail(std::string(dlerror()));
    }
    Egl egl;
    egl.get = reinterpret_cast<GetProcAddress>(dlsym(handle, "eglGetProcAddress"));
    const bool complete =
        egl.get != nullptr && egl.find(egl.platformDisplay, "eglGetPlatformDisplayEXT") &&
        egl.find(egl.initialize, "eglInitialize") && egl.find(egl.bindApi, "eglBindAPI") &&
        egl.find(egl.chooseConfig, "eglChooseConfig") &&
        egl.find(egl.createContext, "eglCreateContext") &&
        egl.find(egl.makeCurrent, "eglMakeCurrent");
    if (!complete) {
        return fail(library + ": lacks functions of EGL 1.5");
    }
    return egl;
}

EGLDisplay displayOf(const Egl& egl, Driver driver) {
    if (driver == Driver::llvmpipe) {
        return egl.platformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    }
    const EGLint attributes[] = {kAnglePlatformType, kAngleTypeVulkan, kAngleDeviceType,
                                 kAngleDeviceSwiftShader, EGL_NONE};
    return egl.platformDisplay(kAnglePlatform, nullptr, attributes);
}

Result<void> makeContext(const Egl& egl, Driver driver) {
    EGLDisplay display = displayOf(egl, driver);
    if (display == EGL_NO_DISPLAY || egl.initialize(display, nullptr, nullptr) == EGL_FALSE ||
        egl.bindApi(EGL_OPENGL_ES_API) == EGL_FALSE) {
        return fail("EGL has no display without a window");
    }
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0,
                             EGL_NONE};
    EGLConfig config{};
    EGLint found = 0;
    egl.chooseConfig(display, wanted, &config, 1, &found);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLContext context =
        egl.createContext(display, found > 0 ? config : nullptr, EGL_NO_CONTEXT, version);
    if (context == EGL_NO_CONTEXT ||
        egl.makeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
        return fail("EGL gives no OpenGL ES 3 context without a surface");
    }
    return {};
}

Result<GLuint> compile(const Gl& gl, GLenum kind, const std::string& source) {
    const GLuint shader = gl.glCreateShader(kind);
    const char* text = source.c_str();
    gl.glShaderSource(shader, 1, &text, nullptr);
    gl.glCompileShader(shader);
    GLint good = 0;
    gl.glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == 0) {
        char log[2048] = "";
        gl.glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        return fail("shader: " + std::string(log) + "\n" + source);
    }
    return shader;
}

std::string textOf(const Gl& gl, GLenum name) {
    const GLubyte* text = gl.glGetString(name);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

}  // namespace

Result<Gl> openGl(Driver driver, const std::string& folder, int threads) {
    const std::string count = std::to_string(threads);
    setenv("LP_NUM_THREADS", count.c_str(), 1);
    setenv("EGL_PLATFORM", "surfaceless", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    std::string library = "libEGL.so.1";
    if (driver == Driver::swiftshader) {
        const std::string place = folder.empty() ? "/usr/lib/chromium" : folder;
        library = place + "/libEGL.so";
        setenv("VK_ICD_FILENAMES", (place + "/vk_swiftshader_icd.json").c_str(), 1);
    }
    const Result<Egl> egl = openEgl(library);
    if (!egl) {
        return tl::make_unexpected(egl.error());
    }
    if (Result<void> made = makeContext(*egl, driver); !made) {
        return tl::make_unexpected(made.error());
    }
    Gl gl;
    bool complete = true;
#define STILL_PEER_LOAD(type, name)                    \
    gl.name = reinterpret_cast<type>(egl->get(#name)); \
    complete &= gl.name != nullptr;
    STILL_PEER_GL_FUNCTIONS(STILL_PEER_LOAD)
#undef STILL_PEER_LOAD
    if (!complete) {
        return fail(library + ": lacks functions of OpenGL ES 3");
    }
    gl.driver = driver;
    gl.renderer = textOf(gl, GL_RENDERER);
    gl.version = textOf(gl, GL_VERSION);
    if (textOf(gl, GL_EXTENSIONS).find("GL_EXT_clip_control") != std::string::npos) {
        gl.glClipControlEXT =
            reinterpret_cast<PFNGLCLIPCONTROLEXTPROC>(egl->get("glClipControlEXT"));
    }
    return gl;
}

Result<GLuint> makeProgram(const Gl& gl, const ProgramSource& source) {
    const Result<GLuint> vertex = compile(gl, GL_VERTEX_SHADER, source.vertex);
    if (!vertex) {
        return vertex;
    }
    const Result<GLuint> fragment = compile(gl, GL_FRAGMENT_SHADER, source.fragment);
    if (!fragment) {
        return fragment;
    }
    const GLuint program = gl.glCreateProgram();
    gl.glAttachShader(program, *vertex);
    gl.glAttachShader(program, *fragment);
    for (size_t i = 0; i < source.attributes.size(); ++i) {
        gl.glBindAttribLocation(program, GLuint(i), source.attributes[i]);
    }
    gl.glLinkProgram(program);
    GLint good = 0;
    gl.glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good == 0) {
        char log[2048] = "";
        gl.glGetProgramInfoLog(program, sizeof log, nullptr, log);
        return fail("program: " + std::string(log));
    }
    return program;
}

GLuint makeTarget(const Gl& gl, GLenum format, int width, int height, GLint filter) {
    GLuint texture = 0;
    gl.glGenTextures(1, &texture);
    gl.glBindTexture(GL_TEXTURE_2D, texture);
    gl.glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

}  // namespace still::peer
