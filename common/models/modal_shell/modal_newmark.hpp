#pragma once
#include <span>
#include <vector>

namespace palpate {

/// Rate d [1/s] of each mode's equation x'' + d x' + omega^2 x = f: `mass_damping` [1/s] if it is positive (B
/// = alpha M, BHS01 eq. 21), else 2 ratio omega (eq. 20).
std::vector<double> modal_damping(std::span<const double> omega, double ratio, double mass_damping);

/// Constants of one time step of decoupled modes, by the trapezoidal rule, which is Newmark's average
/// acceleration (beta = 1/4, gamma = 1/2) for the mean force of the step. With K^ = omega^2 + 2 d/h + 4/h^2.
struct ModalConstants {
  std::vector<double> omega2;   ///< [1/s^2]
  std::vector<double> damping;  ///< [1/s] d
  std::vector<double> inverse;  ///< [s^2] 4/K^: change of y = h v_{t+h} per modal force held over the step
  std::vector<double> carry;    ///< [s] of v_t in y
  std::vector<double> pull;     ///< [1] of x_t in y, negative
  double h = 0;                 ///< [s]

  int modes() const { return static_cast<int>(omega2.size()); }
};

/// `omega` [rad/s], `damping` [1/s] from modal_damping(), `h` [s].
ModalConstants make_modal_constants(std::span<const double> omega, std::span<const double> damping, double h);

/// y = h v_{t+h} [kg^1/2 m] of every mode, from x_t [kg^1/2 m] and v_t [kg^1/2 m/s], under the modal force f
/// = Phi^T F [N kg^-1/2] held over the step. Allocates nothing.
void free_motion(const ModalConstants& constants, const double* x, const double* v, const double* force, double* y);

/// Ends the step: v_{t+h} = y/h, x_{t+h} = x_t + h/2 (v_t + v_{t+h}). `y`: free_motion() plus inverse times
/// the forces that it did not hold.
void advance(const ModalConstants& constants, double* x, double* v, const double* y);

/// The same scheme as BHS01 app. B prints it ("NIRMS"): position, velocity and acceleration, in equilibrium
/// at the end of each step. Begins from modal coordinates X_0 = Phi^T M U_0 (printed Phi U_0).
class ModalNewmark {
 public:
  ModalNewmark(std::span<const double> omega, std::span<const double> damping, double h);

  /// All of length modes; `force` acts at the beginning.
  void start(std::span<const double> x, std::span<const double> v, std::span<const double> force);
  /// One step; `force` acts at its end. Allocates nothing.
  void step(std::span<const double> force);

  std::span<const double> position() const { return x_; }
  std::span<const double> velocity() const { return v_; }
  std::span<const double> acceleration() const { return a_; }

 private:
  std::vector<double> omega2_, damping_;
  double h_;
  std::vector<double> x_, v_, a_;
};

}  // namespace palpate
