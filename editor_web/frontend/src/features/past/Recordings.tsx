/** The recordings that lie in the project. */
import { Box, List, Text } from '@mantine/core'
import { IconFileAnalytics } from '@tabler/icons-react'
import { Refusal } from '../../components/Refusal'
import { useAnswer } from '../../api/queryClient'
import { pastQueries } from '../../api/timeline'
import type { RecordingFile } from '../../api/types'
import { Empty } from '../../components/Empty'
import { PageLink } from '../../components/PageLink'
import { wallTime } from '../../document/time'
import { nameOfPath } from '../../document/path'
import classes from './past.module.css'

export interface RecordingsProps {
  readonly href: (path: string) => string
  readonly onOpen: (path: string) => void
}

export function Recordings({ href, onOpen }: RecordingsProps) {
  const { value: files, problem } = useAnswer(pastQueries.recordings())
  return (
    <Box h="100%" px="md" pt="sm" pb="lg" style={{ overflow: 'auto' }}>
      <Refusal>{problem}</Refusal>
      {files?.length === 0 && (
        <Empty icon={<IconFileAnalytics size={26} stroke={1.4} aria-hidden />} title="No recordings">
          Record a run with <code>flexcell run --record FILE.mcap</code>; recordings anywhere in the project are listed here.
        </Empty>
      )}
      <List listStyleType="none" aria-label="Recordings">
        {files?.map((file) => (
          <Box component="li" key={file.path} style={{ borderBottom: '1px solid var(--line)' }}>
            {file.problem ? (
              <div className={classes.item}>
                <Named file={file} />
                <Text span fz="0.78rem" lineClamp={2} c="var(--failed)">
                  {file.problem}
                </Text>
              </div>
            ) : (
              <PageLink className={`${classes.item} pick-row`} href={href(file.path)} onOpen={() => onOpen(file.path)}>
                <Named file={file} />
              </PageLink>
            )}
          </Box>
        ))}
      </List>
    </Box>
  )
}

function Named({ file }: { file: RecordingFile }) {
  return (
    <>
      <Text span inherit truncate fw={620} display="block">
        {file.behavior || nameOfPath(file.path)}
      </Text>
      <Text span display="block" fz="0.78rem" c="dimmed">
        {wallTime(file.started_at_s)} · {size(file.size_bytes)}
      </Text>
      <Text span display="block" fz="0.72rem" ff="monospace" c="dimmed" style={{ overflowWrap: 'anywhere' }}>
        {file.path}
      </Text>
    </>
  )
}

function size(bytes: number): string {
  return bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toFixed(1)} MB`
}
