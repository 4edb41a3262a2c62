// An effort controller: angles in, torques out, by NAME_step of lyapcheck export.
// Written for the interfaces of ROS 2 Jazzy and later; no ROS was at hand where this file was written.
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "controller_interface/controller_interface.hpp"
#include "pluginlib/class_list_macros.hpp"
#include "std_msgs/msg/float64_multi_array.hpp"

#include GAINS_HEADER

#define JOINED(a, b) a##_##b
#define OF(name, what) JOINED(name, what)
#define MINE(what) OF(GAINS, what)

namespace lyapcheck_controller
{
constexpr std::size_t N = MINE(JOINTS);
using controller_interface::CallbackReturn;
using controller_interface::InterfaceConfiguration;

class Controller : public controller_interface::ControllerInterface
{
public:
  CallbackReturn on_init() override
  {
    auto_declare<std::vector<std::string>>("joints", {});
    return CallbackReturn::SUCCESS;
  }

  CallbackReturn on_configure(const rclcpp_lifecycle::State &) override
  {
    joints_ = get_node()->get_parameter("joints").as_string_array();
    const double rate = get_update_rate();
    if (joints_.size() != N) {
      RCLCPP_ERROR(get_node()->get_logger(), "joints: give %zu names, base first", N);
      return CallbackReturn::ERROR;
    }
    if (std::fabs(rate * MINE(PERIOD) - 1.0) > 1e-6) {
      RCLCPP_ERROR(
        get_node()->get_logger(), "update_rate is %g Hz, but the gains were exported for %g Hz", rate,
        1.0 / MINE(PERIOD));
      return CallbackReturn::ERROR;
    }
    subscription_ = get_node()->create_subscription<std_msgs::msg::Float64MultiArray>(
      "~/goal", 1, [this](const std_msgs::msg::Float64MultiArray & message) {
        for (std::size_t i = 0; i < N && message.data.size() == N; i++) {
          goal_[i].store(message.data[i]);
        }
      });
    return CallbackReturn::SUCCESS;
  }

  InterfaceConfiguration command_interface_configuration() const override { return interfaces("effort"); }

  InterfaceConfiguration state_interface_configuration() const override { return interfaces("position"); }

  CallbackReturn on_activate(const rclcpp_lifecycle::State &) override
  {
    state_ = MINE(state){};
    std::array<double, N> q{};
    read(q);
    for (std::size_t i = 0; i < N; i++) {
      if (!std::isfinite(q[i])) {
        RCLCPP_ERROR(get_node()->get_logger(), "%s has no reading", joints_[i].c_str());
        return CallbackReturn::ERROR;
      }
      goal_[i].store(q[i]);  // stay until a goal comes
    }
    return CallbackReturn::SUCCESS;
  }

  controller_interface::return_type update(const rclcpp::Time &, const rclcpp::Duration &) override
  {
    std::array<double, N> q{}, goal{}, tau{};
    read(q);
    for (std::size_t i = 0; i < N; i++) {
      goal[i] = goal_[i].load();
    }
    const int flag = MINE(step)(&state_, q.data(), goal.data(), tau.data());
    bool sent = true;
    for (std::size_t i = 0; i < N; i++) {
      sent = command_interfaces_[i].set_value(tau[i]) && sent;
    }
    if (flag == MINE(GRAVITY) || !sent) {
      RCLCPP_ERROR_THROTTLE(
        get_node()->get_logger(), *get_node()->get_clock(), 1000, "no readings, or torques not taken");
      return controller_interface::return_type::ERROR;
    }
    return controller_interface::return_type::OK;
  }

  CallbackReturn on_deactivate(const rclcpp_lifecycle::State &) override { return CallbackReturn::SUCCESS; }

private:
  InterfaceConfiguration interfaces(const std::string & kind) const
  {
    InterfaceConfiguration result{controller_interface::interface_configuration_type::INDIVIDUAL, {}};
    for (const auto & joint : joints_) {
      result.names.push_back(joint + "/" + kind);
    }
    return result;
  }

  // A reading that cannot be had is NaN, which NAME_step holds through.
  void read(std::array<double, N> & q)
  {
    for (std::size_t i = 0; i < N; i++) {
      q[i] = state_interfaces_[i].get_optional().value_or(std::numeric_limits<double>::quiet_NaN());
    }
  }

  std::vector<std::string> joints_;
  std::array<std::atomic<double>, N> goal_{};
  MINE(state) state_{};
  rclcpp::Subscription<std_msgs::msg::Float64MultiArray>::SharedPtr subscription_;
};
}  // namespace lyapcheck_controller

PLUGINLIB_EXPORT_CLASS(lyapcheck_controller::Controller, controller_interface::ControllerInterface)
