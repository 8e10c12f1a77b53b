#include "calot/window/bindings.h"

#include <GLFW/glfw3.h>

namespace calot::window {

using viewer::Action;

const std::vector<HeldKey>& held_keys() {
    static const std::vector<HeldKey> keys{
        {GLFW_KEY_C, Action::yellow_pedal},
        {GLFW_KEY_V, Action::blue_pedal},
        {GLFW_KEY_Q, Action::roll_left},
        {GLFW_KEY_E, Action::roll_right},
        {GLFW_KEY_W, Action::deeper},
        {GLFW_KEY_S, Action::back_out},
        {GLFW_KEY_LEFT_SHIFT, Action::left_hand},
        {GLFW_KEY_A, Action::suction},
        {GLFW_KEY_D, Action::irrigation},
        {GLFW_KEY_Z, Action::wipe_tip},
        {GLFW_KEY_LEFT, Action::scope_left},
        {GLFW_KEY_RIGHT, Action::scope_right},
        {GLFW_KEY_UP, Action::scope_up},
        {GLFW_KEY_DOWN, Action::scope_down},
        {GLFW_KEY_PAGE_UP, Action::scope_in},
        {GLFW_KEY_PAGE_DOWN, Action::scope_out},
        {GLFW_KEY_COMMA, Action::lens_left},
        {GLFW_KEY_PERIOD, Action::lens_right},
        {GLFW_KEY_INSERT, Action::horizon_left},
        {GLFW_KEY_DELETE, Action::horizon_right},
    };
    return keys;
}

const std::vector<HelpGroup>& help() {
    static const std::vector<HelpGroup> groups{
        {"help.hook",
         {{"keys.mouse", "help.hook.move"},
          {"keys.wheel", "help.hook.depth"},
          {"Q  E", "help.hook.roll"},
          {"keys.left_button", "help.yellow"},
          {"keys.right_button", "help.blue"},
          {"Z", "help.wipe_tip"}}},
        {"help.grasper", {{"keys.shift_mouse", "help.grasper.move"}, {"R", "help.grasper.jaws"}}},
        {"help.scope",
         {{"keys.arrows", "help.scope.turn"},
          {"keys.page", "help.scope.depth"},
          {",  .", "help.scope.lens"},
          {"keys.insert_delete", "help.scope.horizon"},
          {"1  2  3  4", "help.scope.presets"},
          {"X", "help.scope.wipe"}}},
        {"help.fluids", {{"A", "help.suction"}, {"D", "help.irrigation"}}},
        {"help.session",
         {{"Esc", "help.pause"},
          {"F1", "help.help"},
          {"F2", "help.pace"},
          {"F5", "help.reset"},
          {"F11", "help.fullscreen"},
          {"F12", "help.picture"},
          {"M", "help.mute"}}},
        {"help.pad",
         {{"keys.pad.right_stick", "help.pad.hook"},
          {"keys.pad.left_stick", "help.pad.grasper"},
          {"keys.pad.shoulders", "help.pad.depth"},
          {"keys.pad.triggers", "help.pad.pedals"},
          {"A  B  X  Y", "help.pad.buttons"},
          {"keys.pad.cross", "help.pad.scope"}}},
    };
    return groups;
}

}  // namespace calot::window
