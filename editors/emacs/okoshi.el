;;; okoshi.el --- Language support for drawings with okoshi strings  -*- lexical-binding: t; -*-

;; Version: 0.2.0
;; Package-Requires: ((emacs "27.1") (eglot "1.9"))
;; SPDX-License-Identifier: MIT OR Apache-2.0

;;; Commentary:

;; Starts okoshi's language server through Eglot in buffers that show the text of an SVG file.  If Emacs opens the file as a
;; picture, C-c C-c switches to the text.  Requires the program `okoshi' on the PATH.
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
  "Command line of the language server."
  :type '(repeat string))

(defclass okoshi-server (eglot-lsp-server) ()
  :documentation "Okoshi's language server.")

(cl-defmethod eglot-client-capabilities ((_server okoshi-server))
  "Announce support for `window/showDocument'."
  (let* ((known (cl-call-next-method))
         (window (copy-sequence (plist-get known :window))))
    (plist-put known :window (plist-put window :showDocument '(:support t)))))

(cl-defmethod eglot-handle-request
  ((_server okoshi-server) (_method (eql window/showDocument)) &key uri selection &allow-other-keys)
  "Show URI: the preview page, or the drawing at SELECTION."
  (cond ((not (string-prefix-p "http://" uri))
         (let ((path (url-filename (url-generic-parse-url uri))))
           (pop-to-buffer (find-file-noselect (decode-coding-string (url-unhex-string path) 'utf-8)))
           (when selection
             (goto-char (eglot--lsp-position-to-point (plist-get selection :start))))))
        ((display-graphic-p) (browse-url uri))
        (t (message "the preview is at %s" uri)))
  '(:success t))

(defun okoshi-preview ()
  "Open a live 3D preview of the drawing in this buffer."
  (interactive)
  (let ((server (or (eglot-current-server) (user-error "This buffer has no language server")))
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
  "Start the language server if the buffer shows the text of a drawing."
  (when (okoshi--drawing-p)
    ;; Buffer-local: other XML may have another server.
    (setq-local eglot-server-programs
                (cons `((nxml-mode) . (okoshi-server . ,okoshi-command))
                      eglot-server-programs))
    ;; In `nxml-mode' `$' is a word character, but here keywords begin after it.
    (let ((signs (make-syntax-table (syntax-table))))
      (modify-syntax-entry ?$ "." signs)
      (modify-syntax-entry ?＄ "." signs)
      (set-syntax-table signs))
    (eglot-ensure)))

(defun okoshi-show-text ()
  "Show a drawing's text if `image-mode' cannot show it, as in terminals."
  (when (and (okoshi--drawing-p) (eq major-mode 'fundamental-mode))
    (nxml-mode)))

;;;###autoload
(add-hook 'nxml-mode-hook #'okoshi-ensure)
;;;###autoload
(add-hook 'find-file-hook #'okoshi-show-text)

(provide 'okoshi)
;;; okoshi.el ends here
