"""What `flexcell doctor` looks at: the installation, the folders and ports of a server, and the machine."""
