"""What `import onpath` gives in Python, a notebook for example."""
