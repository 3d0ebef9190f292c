#include "tests/bench/peer/shaders.h"

namespace still::peer {
namespace {

constexpr const char* kHeader = "#version 300 es\nprecision highp float;\nprecision highp int;\n";

constexpr const char* kGbufferVertex = R"(
in vec3 a_position;
in vec3 a_normal;
in vec2 a_uv;
in vec4 a_tangent;
uniform mat4 u_clip;
uniform mat4 u_before;
uniform mat4 u_world;
uniform mat3 u_normal_matrix;
uniform vec2 u_uv_offset;
#ifndef DEPTH_ONLY
out vec3 v_normal;
out vec3 v_before;
#endif
#ifdef UV
out vec2 v_uv;
#endif
#ifdef POSITION
out vec3 v_position;
#endif
#ifdef NORMAL_MAP
out vec4 v_tangent;
#endif
void main() {
    vec4 position = vec4(a_position, 1.0);
    gl_Position = u_clip * position;
#ifndef DEPTH_ONLY
    v_normal = u_normal_matrix * a_normal;
    v_before = (u_before * position).xyw;
#endif
#ifdef UV
    v_uv = a_uv + u_uv_offset;
#endif
#ifdef POSITION
    v_position = (u_world * position).xyz;
#endif
#ifdef NORMAL_MAP
    v_tangent = vec4(mat3(u_world) * a_tangent.xyz, a_tangent.w);
#endif
}
)";

constexpr const char* kAlpha = R"(
#ifdef ALPHA_TEST
uniform float u_opacity;
#ifdef ALPHA_TEXTURE
uniform sampler2D u_alpha;
#endif
void testAlpha() {
    float alpha = u_opacity;
#ifdef ALPHA_TEXTURE
    alpha *= texture(u_alpha, v_uv).r;
#endif
    if (alpha < 0.5) {
        discard;
    }
}
#else
void testAlpha() {}
#endif
)";

constexpr const char* kDepthFragment = R"(
#ifdef UV
in vec2 v_uv;
#endif
//ALPHA
void main() {
    testAlpha();
}
)";

constexpr const char* kGbufferFragment = R"(
in vec3 v_normal;
in vec3 v_before;
#ifdef UV
in vec2 v_uv;
#endif
#ifdef POSITION
in vec3 v_position;
uniform vec3 u_eye;
#endif
#ifdef NORMAL_MAP
in vec4 v_tangent;
uniform sampler2D u_normal_map;
#endif
#ifdef COLOUR_TEXTURE
uniform sampler2D u_colour;
#endif
uniform float u_side;  // of the object's space: -1 mirrored
uniform vec3 u_ambient, u_to_sun, u_sun, u_diffuse, u_specular, u_emission;
uniform float u_shininess;
uniform vec2 u_sample;
#if POINTS > 0
uniform vec3 u_point_position[POINTS];
uniform vec3 u_point_colour[POINTS];
#endif
layout(location = 0) out vec4 o_colour;
layout(location = 1) out vec4 o_normal;
layout(location = 2) out vec2 o_motion;
//ALPHA
vec3 g_diffuse, g_specular;
void addLight(vec3 n, vec3 to_light, vec3 colour, float attenuation, vec3 to_eye) {
    float cosine = max(dot(n, to_light), 0.0) * attenuation;
    g_diffuse += colour * cosine;
#ifdef HIGHLIGHT
    vec3 half_way = normalize(to_light + to_eye);
    float shine = pow(max(dot(n, half_way), 0.0), u_shininess) * attenuation;
    g_specular += cosine > 0.0 ? colour * shine : vec3(0.0);
#endif
}
void main() {
    testAlpha();
    vec3 n = normalize(v_normal);
#ifdef NORMAL_MAP
    vec3 t = normalize(v_tangent.xyz);
    vec3 b = cross(n, t) * (v_tangent.w * u_side);
    vec3 m = texture(u_normal_map, v_uv).xyz * 2.0 - 1.0;
    n = normalize(t * m.x + b * m.y + n * m.z);
#endif
    n *= gl_FrontFacing ? u_side : -u_side;
    g_diffuse = u_ambient;
    g_specular = vec3(0.0);
    vec3 to_eye = vec3(0.0);
#ifdef POSITION
    to_eye = normalize(u_eye - v_position);
#endif
    addLight(n, u_to_sun, u_sun, 1.0, to_eye);
#if POINTS > 0
    for (int i = 0; i < POINTS; ++i) {
        vec3 to = u_point_position[i] - v_position;
        float inverse_square = 1.0 / max(dot(to, to), 1e-12);
        addLight(n, to * sqrt(inverse_square), u_point_colour[i], inverse_square, to_eye);
    }
#endif
    vec3 albedo = u_diffuse;
#ifdef COLOUR_TEXTURE
    vec3 texel = texture(u_colour, v_uv).rgb;
    albedo *= texel * texel;
#endif
    vec3 colour = albedo * g_diffuse + u_emission;
#ifdef HIGHLIGHT
    colour += u_specular * g_specular;
#endif
    o_colour = vec4(colour, gl_FragCoord.w);  // 1 / w, for the search of the nearest neighbour
    o_normal = vec4(n * 0.5 + 0.5, 1.0);
    o_motion = v_before.xy / v_before.z - (gl_FragCoord.xy + u_sample);
}
)";

constexpr const char* kWholeTarget = R"(
void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}
)";

// Karis, "High-quality temporal supersampling", 2014; Salvi, "An excursion in temporal
// supersampling", 2016 (variance clip); Jimenez, "Filmic SMAA", 2016 (Catmull-Rom by five bilinear
// taps, the corners left out). Of the variants that were measured on llvmpipe this is the fastest:
// sampling with constant offsets is faster than texelFetch, and nearness in the colour's alpha is
// faster than the depth plane, gathered or not.
constexpr const char* kTemporalFragment = R"(
uniform sampler2D u_colour, u_motion, u_history;
uniform vec2 u_size, u_pixel;  // in pixels, and one pixel in texture coordinates
uniform float u_keep;          // weight of history; 0 in the first frame
layout(location = 0) out vec4 o_history;
float g_nearness;
vec2 g_nearest;
vec3 g_sum, g_squares;
vec3 toYcocg(vec3 c) {
    return vec3(dot(c, vec3(0.25, 0.5, 0.25)), dot(c, vec3(0.5, 0.0, -0.5)),
                dot(c, vec3(-0.25, 0.5, -0.25)));
}
vec3 toRgb(vec3 c) {
    float t = c.x - c.z;
    return vec3(t + c.y, c.x + c.z, t - c.y);
}
vec3 historyAt(vec2 at) {
    vec2 centre = floor(at - 0.5) + 0.5;
    vec2 f = at - centre;
    vec2 w0 = f * (f * (1.0 - 0.5 * f) - 0.5);
    vec2 w1 = 1.0 + f * f * (1.5 * f - 2.5);
    vec2 w3 = f * f * (0.5 * f - 0.5);
    vec2 w12 = 1.0 - w0 - w3;
    vec2 middle = (centre + (w12 - w1) / w12) * u_pixel;
    vec2 before = (centre - 1.0) * u_pixel;
    vec2 after = (centre + 2.0) * u_pixel;
    float left = w0.x * w12.y, right = w3.x * w12.y, low = w12.x * w0.y, high = w12.x * w3.y;
    float inner = w12.x * w12.y;
    vec3 sum = textureLod(u_history, middle, 0.0).rgb * inner;
    sum += textureLod(u_history, vec2(before.x, middle.y), 0.0).rgb * left;
    sum += textureLod(u_history, vec2(after.x, middle.y), 0.0).rgb * right;
    sum += textureLod(u_history, vec2(middle.x, before.y), 0.0).rgb * low;
    sum += textureLod(u_history, vec2(middle.x, after.y), 0.0).rgb * high;
    return max(sum / (inner + left + right + low + high), 0.0);
}
void take(vec4 s, vec2 offset) {
    bool nearer = s.a > g_nearness;
    g_nearness = nearer ? s.a : g_nearness;
    g_nearest = nearer ? offset : g_nearest;
    vec3 c = toYcocg(s.rgb);
    g_sum += c;
    g_squares += c * c;
}
#define TAKE(x, y) take(textureLodOffset(u_colour, uv, 0.0, ivec2(x, y)), vec2(x, y))
void main() {
    vec2 uv = gl_FragCoord.xy * u_pixel;
    vec4 centre = textureLod(u_colour, uv, 0.0);
    vec3 here = toYcocg(centre.rgb);
    g_nearness = centre.a;
    g_nearest = vec2(0.0);
    g_sum = here;
    g_squares = here * here;
    TAKE(-1, -1);
    TAKE(0, -1);
    TAKE(1, -1);
    TAKE(-1, 0);
    TAKE(1, 0);
    TAKE(-1, 1);
    TAKE(0, 1);
    TAKE(1, 1);
    vec2 at = gl_FragCoord.xy + textureLod(u_motion, uv + g_nearest * u_pixel, 0.0).xy;
    vec3 mean = g_sum * (1.0 / 9.0);
    vec3 deviation = sqrt(max(g_squares * (1.0 / 9.0) - mean * mean, 0.0)) * 1.25;
    vec3 history = toYcocg(historyAt(at));
    vec3 offset = history - mean;
    vec3 over = abs(offset) / max(deviation, vec3(1e-6));
    float farthest = max(max(over.x, over.y), max(over.z, 1.0));
    history = mean + offset / farthest;
    bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, u_size));
    vec3 mixed = mix(here, history, inside ? u_keep : 0.0);
    o_history = vec4(toRgb(mixed), 1.0);
}
)";

constexpr const char* kOutputFragment = R"(
uniform sampler2D u_colour;
layout(location = 0) out vec4 o_colour;
void main() {
    vec3 c = clamp(texelFetch(u_colour, ivec2(gl_FragCoord.xy), 0).rgb, 0.0, 1.0);
    vec3 high = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
    o_colour = vec4(mix(high, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308)))), 1.0);
}
)";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
        text.replace(at, what.size(), with);
        at += with.size();
    }
    return text;
}

}  // namespace

ProgramSource gbufferProgram(uint32_t features) {
    std::string head = kHeader;
    const auto define = [&](bool wanted, const char* name) {
        head += wanted ? "#define " + std::string(name) + "\n" : "";
    };
    const uint32_t points = features >> kPointLightShift;
    define((features & kColourTexture) != 0, "COLOUR_TEXTURE");
    define((features & kNormalMap) != 0, "NORMAL_MAP");
    define((features & kAlphaTest) != 0, "ALPHA_TEST");
    define((features & kAlphaTexture) != 0, "ALPHA_TEXTURE");
    define((features & kHighlight) != 0, "HIGHLIGHT");
    define((features & kDepthOnly) != 0, "DEPTH_ONLY");
    define((features & (kColourTexture | kNormalMap | kAlphaTexture)) != 0, "UV");
    define((features & kHighlight) != 0 || points > 0, "POSITION");
    head += "#define POINTS " + std::to_string(points) + "\n";
    const char* fragment = (features & kDepthOnly) != 0 ? kDepthFragment : kGbufferFragment;
    return {head + kGbufferVertex,
            head + replaced(fragment, "//ALPHA", kAlpha),
            {"a_position", "a_normal", "a_uv", "a_tangent"}};
}

ProgramSource temporalProgram() {
    return {std::string(kHeader) + kWholeTarget, std::string(kHeader) + kTemporalFragment, {}};
}

ProgramSource outputProgram() {
    return {std::string(kHeader) + kWholeTarget, std::string(kHeader) + kOutputFragment, {}};
}

}  // namespace still::peer
