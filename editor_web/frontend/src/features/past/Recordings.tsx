/** The recordings that lie in the project. */
import './past.css'
import { IconFileAnalytics } from '@tabler/icons-react'
import { useAnswer } from '../../api/queryClient'
import { pastQueries } from '../../api/timeline'
import type { RecordingFile } from '../../api/types'
import { Empty } from '../../components/Empty'
import { wallTime } from '../../document/time'
import { nameOfPath } from '../../document/path'

export interface RecordingsProps {
  readonly href: (path: string) => string
  readonly onOpen: (path: string) => void
}

export function Recordings({ href, onOpen }: RecordingsProps) {
  const { value: files, problem } = useAnswer(pastQueries.recordings())
  return (
    <div className="past-runs">
      {problem && (
        <p className="past-problem" role="alert">
          {problem}
        </p>
      )}
      {files?.length === 0 && (
        <Empty icon={<IconFileAnalytics size={26} stroke={1.4} aria-hidden />} title="No recordings">
          Record a run with <code>flexcell run --record FILE.mcap</code>; recordings anywhere in the project are listed here.
        </Empty>
      )}
      <ul className="plain-list" aria-label="Recordings">
        {files?.map((file) => (
          <li key={file.path}>
            {file.problem ? (
              <div className="past-item">
                <Named file={file} />
                <span className="past-item-cause">{file.problem}</span>
              </div>
            ) : (
              <a
                className="past-item"
                href={href(file.path)}
                onClick={(event) => {
                  if (event.metaKey || event.ctrlKey || event.shiftKey || event.button !== 0) return
                  event.preventDefault()
                  onOpen(file.path)
                }}
              >
                <Named file={file} />
              </a>
            )}
          </li>
        ))}
      </ul>
    </div>
  )
}

function Named({ file }: { file: RecordingFile }) {
  return (
    <>
      <span className="past-item-name">{file.behavior || nameOfPath(file.path)}</span>
      <span className="quiet past-item-facts">
        {wallTime(file.started_at_s)} · {size(file.size_bytes)}
      </span>
      <span className="quiet mono past-item-id">{file.path}</span>
    </>
  )
}

function size(bytes: number): string {
  return bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toFixed(1)} MB`
}
