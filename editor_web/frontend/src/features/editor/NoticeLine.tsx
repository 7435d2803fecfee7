/** What the editor has to say: a refusal with its advice, a draft taken up again, a file that changed. */
import { CloseButton } from '@mantine/core'
import { IconAlertTriangle, IconCheck, IconHistory } from '@tabler/icons-react'
import { useEffect } from 'react'
import { discard, save } from './session'
import { editor, setEditor, useEditor } from './store'

const SHORT_MS = 2500

export function NoticeLine() {
  const notice = useEditor((s) => s.notice)
  const isRestored = useEditor((s) => s.isRestored)
  const isOutdated = useEditor((s) => s.isOutdated)
  useEffect(() => {
    if (notice?.tone !== 'done') return
    const timer = setTimeout(() => editor().notice === notice && setEditor({ notice: undefined }), SHORT_MS)
    return () => clearTimeout(timer)
  }, [notice])
  return (
    <>
      {isOutdated && (
        <div className="edit-note is-warning" role="alert">
          <IconAlertTriangle size={16} aria-hidden />
          <span>The file has changed on disk since you began. Saving shows both.</span>
          <button type="button" className="link" onClick={() => void save()}>
            Compare now
          </button>
          <button type="button" className="link" onClick={() => void discard()}>
            Take the file
          </button>
        </div>
      )}
      {isRestored && !isOutdated && (
        <div className="edit-note" role="status">
          <IconHistory size={16} aria-hidden />
          <span>Your unsaved changes of an earlier visit are here.</span>
          <button type="button" className="link" onClick={() => void discard()}>
            Discard them
          </button>
          <CloseButton size="sm" aria-label="Close this note" onClick={() => setEditor({ isRestored: false })} />
        </div>
      )}
      {notice?.tone === 'refused' && (
        <div className="edit-note is-refused" role="alert">
          <IconAlertTriangle size={16} aria-hidden />
          <span>
            <strong>{notice.what}</strong>: {notice.message}
            {notice.hint && <span className="quiet"> {notice.hint}</span>}
          </span>
          <CloseButton size="sm" aria-label="Close this note" onClick={() => setEditor({ notice: undefined })} />
        </div>
      )}
      <div className="edit-toast" role="status">
        {notice?.tone === 'done' && (
          <span>
            <IconCheck size={15} aria-hidden /> {notice.message}
          </span>
        )}
      </div>
    </>
  )
}
