#pragma once
// OpenGL ES 3 without a window: the library is chosen at run time, every function is asked of it by
// name, so that one program runs on Mesa and on ANGLE.

#include <string>

#include "engine/result.h"

#define EGL_EGL_PROTOTYPES 0
#define GL_GLES_PROTOTYPES 0
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl31.h>
// clang-format off
#include <GLES2/gl2ext.h>
// clang-format on

namespace still::peer {

// The functions that are used: X(type of pointer, name).
#define STILL_PEER_GL_FUNCTIONS(X)                                               \
    X(PFNGLACTIVETEXTUREPROC, glActiveTexture)                                   \
    X(PFNGLATTACHSHADERPROC, glAttachShader)                                     \
    X(PFNGLBINDATTRIBLOCATIONPROC, glBindAttribLocation)                         \
    X(PFNGLBINDBUFFERPROC, glBindBuffer)                                         \
    X(PFNGLBINDFRAMEBUFFERPROC, glBindFramebuffer)                               \
    X(PFNGLBINDRENDERBUFFERPROC, glBindRenderbuffer)                             \
    X(PFNGLBINDTEXTUREPROC, glBindTexture)                                       \
    X(PFNGLBINDVERTEXARRAYPROC, glBindVertexArray)                               \
    X(PFNGLBLITFRAMEBUFFERPROC, glBlitFramebuffer)                               \
    X(PFNGLBUFFERDATAPROC, glBufferData)                                         \
    X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, glCheckFramebufferStatus)                 \
    X(PFNGLCLEARBUFFERFVPROC, glClearBufferfv)                                   \
    X(PFNGLCOMPILESHADERPROC, glCompileShader)                                   \
    X(PFNGLCREATEPROGRAMPROC, glCreateProgram)                                   \
    X(PFNGLCREATESHADERPROC, glCreateShader)                                     \
    X(PFNGLDEPTHFUNCPROC, glDepthFunc)                                           \
    X(PFNGLDISABLEPROC, glDisable)                                               \
    X(PFNGLDRAWARRAYSPROC, glDrawArrays)                                         \
    X(PFNGLDRAWBUFFERSPROC, glDrawBuffers)                                       \
    X(PFNGLDRAWELEMENTSPROC, glDrawElements)                                     \
    X(PFNGLENABLEPROC, glEnable)                                                 \
    X(PFNGLENABLEVERTEXATTRIBARRAYPROC, glEnableVertexAttribArray)               \
    X(PFNGLFINISHPROC, glFinish)                                                 \
    X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, glFramebufferRenderbuffer)               \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, glFramebufferTexture2D)                     \
    X(PFNGLGENBUFFERSPROC, glGenBuffers)                                         \
    X(PFNGLGENFRAMEBUFFERSPROC, glGenFramebuffers)                               \
    X(PFNGLGENRENDERBUFFERSPROC, glGenRenderbuffers)                             \
    X(PFNGLGENTEXTURESPROC, glGenTextures)                                       \
    X(PFNGLGENVERTEXARRAYSPROC, glGenVertexArrays)                               \
    X(PFNGLGETPROGRAMINFOLOGPROC, glGetProgramInfoLog)                           \
    X(PFNGLGETPROGRAMIVPROC, glGetProgramiv)                                     \
    X(PFNGLGETSHADERINFOLOGPROC, glGetShaderInfoLog)                             \
    X(PFNGLGETSHADERIVPROC, glGetShaderiv)                                       \
    X(PFNGLGETSTRINGPROC, glGetString)                                           \
    X(PFNGLGETUNIFORMLOCATIONPROC, glGetUniformLocation)                         \
    X(PFNGLLINKPROGRAMPROC, glLinkProgram)                                       \
    X(PFNGLPIXELSTOREIPROC, glPixelStorei)                                       \
    X(PFNGLREADBUFFERPROC, glReadBuffer)                                         \
    X(PFNGLREADPIXELSPROC, glReadPixels)                                         \
    X(PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC, glRenderbufferStorageMultisample) \
    X(PFNGLSHADERSOURCEPROC, glShaderSource)                                     \
    X(PFNGLTEXPARAMETERIPROC, glTexParameteri)                                   \
    X(PFNGLTEXSTORAGE2DPROC, glTexStorage2D)                                     \
    X(PFNGLTEXSUBIMAGE2DPROC, glTexSubImage2D)                                   \
    X(PFNGLUNIFORM1FPROC, glUniform1f)                                           \
    X(PFNGLUNIFORM1IPROC, glUniform1i)                                           \
    X(PFNGLUNIFORM2FPROC, glUniform2f)                                           \
    X(PFNGLUNIFORM3FVPROC, glUniform3fv)                                         \
    X(PFNGLUNIFORMMATRIX3FVPROC, glUniformMatrix3fv)                             \
    X(PFNGLUNIFORMMATRIX4FVPROC, glUniformMatrix4fv)                             \
    X(PFNGLUSEPROGRAMPROC, glUseProgram)                                         \
    X(PFNGLVERTEXATTRIBPOINTERPROC, glVertexAttribPointer)                       \
    X(PFNGLVIEWPORTPROC, glViewport)

/// Which software draws.
enum class Driver {
    llvmpipe,     ///< Mesa's OpenGL on the CPU
    swiftshader,  ///< SwiftShader under ANGLE, the libraries that browsers bring along
};

/// A current context and its functions; one per process, and never given back, because the process
/// ends with it.
struct Gl {
#define STILL_PEER_DECLARE(type, name) type name = nullptr;
    STILL_PEER_GL_FUNCTIONS(STILL_PEER_DECLARE)
#undef STILL_PEER_DECLARE
    PFNGLCLIPCONTROLEXTPROC glClipControlEXT = nullptr;  ///< null where depth cannot be reversed
    Driver driver = Driver::llvmpipe;
    std::string renderer, version;  ///< as the driver names itself
};

/// `threads` are those that rasterize. `folder` has libEGL.so of ANGLE; empty: the usual places.
/// An Error says that this machine has no such driver.
Result<Gl> openGl(Driver driver, const std::string& folder, int threads);

/// Compiles and links; an Error holds the compiler's message. `attributes` get locations 0, 1, …
struct ProgramSource {
    std::string vertex, fragment;
    std::vector<const char*> attributes;
};
Result<GLuint> makeProgram(const Gl& gl, const ProgramSource& source);

/// A texture of one level for drawing into and reading by texel.
GLuint makeTarget(const Gl& gl, GLenum format, int width, int height, GLint filter);

}  // namespace still::peer
