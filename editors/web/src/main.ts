// The page of the live preview.

import "./style/page.css";
import { findHost } from "./host/host";
import { start } from "./page";

const page = document.getElementById("page");
if (page) start(page, findHost());
