"""lyapcheck: the Lyapunov proof of bounded hyperbolic robot controllers, checked equation by equation."""
