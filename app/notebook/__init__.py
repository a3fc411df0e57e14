"""The Python interface of `import onpath`, for notebooks and scripts."""
