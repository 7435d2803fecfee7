/** All sweeps of the project, and making a new one. */
import { Box, Title } from '@mantine/core'
import { useLive } from '../api/live'
import { useAnswer } from '../api/queryClient'
import { sweepQueries } from '../api/sweeps'
import { Empty } from '../components/Empty'
import { PageHead } from '../components/PageHead'
import { NewSweep } from '../features/sweeps/NewSweep'
import { OtherResults, SweepList } from '../features/sweeps/SweepList'
import { sweepHref } from './route'

export function SweepsPage({ onOpen }: { readonly onOpen: (href: string) => void }) {
  const { value, problem } = useAnswer(sweepQueries.list())
  const mayOperate = useLive((s) => s.role) === 'operator'
  return (
    <Box flex={1} mih={0} style={{ overflow: 'auto' }}>
      <PageHead
        isSticky
        title="Sweeps"
        words="How often a behavior succeeds, and how it fails: many runs in simulation, with varied factors"
      >
        {mayOperate && value && <NewSweep taken={value.sweeps.map((each) => each.id)} onMade={(id) => onOpen(sweepHref(id))} />}
      </PageHead>
      {problem && <Empty title="The sweeps cannot be read">{problem}</Empty>}
      {!value && !problem && <div role="status" aria-label="Loading" />}
      {value && (
        <Box maw="60rem" px="md" pt="3xs" pb="xl">
          <SweepList listed={value} href={sweepHref} onOpen={(id) => onOpen(sweepHref(id))} />
          {value.others.length > 0 && (
            <section aria-label="Other results">
              <Title order={2} fz="0.8rem" mt="sm">
                Results that belong to none of them
              </Title>
              <OtherResults others={value.others} />
            </section>
          )}
        </Box>
      )}
    </Box>
  )
}
