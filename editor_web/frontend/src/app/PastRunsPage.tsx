/** All runs of the journal, and beside them the recordings of the project. */
import { Box, VisuallyHidden } from '@mantine/core'
import { Panel } from '../components/Panel'
import { PastRuns } from '../features/past/PastRuns'
import { Recordings } from '../features/past/Recordings'
import classes from './pages.module.css'
import { compareHref, LAST_GOOD, recordingHref, runHref, trendHref } from './route'

export function PastRunsPage({ onOpen }: { onOpen: (href: string) => void }) {
  return (
    <Box className={classes.pair ?? ''} __vars={{ '--widths': 'minmax(0, 3fr) minmax(300px, 2fr)' }}>
      <VisuallyHidden component="h1">Past runs</VisuallyHidden>
      <Panel title="Past runs">
        <PastRuns
          href={runHref}
          trendHref={trendHref}
          onOpen={onOpen}
          onCompare={(left, right) => onOpen(compareHref(left ?? LAST_GOOD, right))}
        />
      </Panel>
      <Panel title="Recordings">
        <Recordings href={recordingHref} onOpen={(path) => onOpen(recordingHref(path))} />
      </Panel>
    </Box>
  )
}
