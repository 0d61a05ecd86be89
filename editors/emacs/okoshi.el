;;; okoshi.el --- Language support for drawings with okoshi strings  -*- lexical-binding: t; -*-

;; Version: 0.1.0
;; Package-Requires: ((emacs "27.1") (eglot "1.9"))
;; SPDX-License-Identifier: MIT OR Apache-2.0

;;; Commentary:

;; Starts okoshi's language server through Eglot wherever the text of an SVG file is shown.  Emacs that can show pictures opens
;; SVG files as such: C-c C-c switches to the text.  Needs the program `okoshi' on the PATH.
;;
;;     (require 'okoshi)

;;; Code:

(require 'eglot)
(require 'url-parse)
(require 'url-util)

(defgroup okoshi nil
  "Drawings that become 3D models."
  :group 'tools)

(defcustom okoshi-command '("okoshi" "lsp")
  "The program that is the language server, and its arguments."
  :type '(repeat string))

(defclass okoshi-server (eglot-lsp-server) ()
  :documentation "Okoshi's language server.")

(cl-defmethod eglot-client-capabilities ((_server okoshi-server))
  "Say that pages and places can be shown."
  (let* ((known (cl-call-next-method))
         (window (copy-sequence (plist-get known :window))))
    (plist-put known :window (plist-put window :showDocument '(:support t)))))

(cl-defmethod eglot-handle-request
  ((_server okoshi-server) (_method (eql window/showDocument)) &key uri selection &allow-other-keys)
  "Show URI: the preview's page, or the drawing where SELECTION was picked."
  (cond ((not (string-prefix-p "http://" uri))
         (let ((path (url-filename (url-generic-parse-url uri))))
           (pop-to-buffer (find-file-noselect (decode-coding-string (url-unhex-string path) 'utf-8)))
           (when selection
             (goto-char (eglot--lsp-position-to-point (plist-get selection :start))))))
        ((display-graphic-p) (browse-url uri))
        (t (message "the preview is at %s" uri)))
  '(:success t))

(defun okoshi-preview ()
  "Show the model of what stands in the buffer, on a page that follows each change."
  (interactive)
  (let ((server (or (eglot-current-server) (user-error "No language server looks at this buffer")))
        (place (plist-get (eglot--TextDocumentIdentifier) :uri)))
    (jsonrpc-async-request server :workspace/executeCommand
                           (list :command "okoshi.preview" :arguments (vector place))
                           :success-fn #'ignore
                           :error-fn (jsonrpc-lambda (&key message &allow-other-keys)
                                       (message "%s" message)))))

(defun okoshi--drawing-p ()
  "Whether the buffer's file is an SVG file."
  (and buffer-file-name
       (string-match-p "\\.svg\\'" (downcase buffer-file-name))))

(defun okoshi-ensure ()
  "Have the language server look at the buffer, if it shows the text of a drawing."
  (when (okoshi--drawing-p)
    ;; For this buffer alone: other XML may have another server.
    (setq-local eglot-server-programs
                (cons `((nxml-mode) . (okoshi-server . ,okoshi-command))
                      eglot-server-programs))
    ;; `nxml-mode' takes `$' for a letter; a keyword begins behind it.
    (let ((signs (make-syntax-table (syntax-table))))
      (modify-syntax-entry ?$ "." signs)
      (modify-syntax-entry ?＄ "." signs)
      (set-syntax-table signs))
    (eglot-ensure)))

(defun okoshi-show-text ()
  "Show a drawing's text where `image-mode' has given up: in terminals it does."
  (when (and (okoshi--drawing-p) (eq major-mode 'fundamental-mode))
    (nxml-mode)))

;;;###autoload
(add-hook 'nxml-mode-hook #'okoshi-ensure)
;;;###autoload
(add-hook 'find-file-hook #'okoshi-show-text)

(provide 'okoshi)
;;; okoshi.el ends here
