"""The mathematics of path following: systems, paths, virtual outputs, controllers, closed loops."""
