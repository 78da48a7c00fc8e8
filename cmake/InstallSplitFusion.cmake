# Installation and the package config (find_package(splitfusion)).
